#pragma once
// A function defined by knots: linear between knots, constant beyond the ends. Two knots at one
// position make a step; the value at that position is that of the second knot.

#include "base/Vector.h"

#include <array>
#include <cstddef>
#include <vector>

namespace fenestra::core {

template <int Channels>
class PiecewiseLinear {
public:
  using Value = Array<double, Channels>;
  struct Knot {
    double position;
    Value value;

    bool operator==(const Knot&) const = default;
  };

  /// At least one knot, finite, in any order (sorted here, stably by position).
  explicit PiecewiseLinear(std::vector<Knot> knots);

  Value operator()(double s) const {
    if (!(s >= m_knots.front().position)) // NaN counts as the low end
      return m_knots.front().value;
    if (s >= m_knots.back().position)
      return m_knots.back().value;
    const std::size_t i = findSegment(s);
    const Knot& a = m_knots[i];
    const Knot& b = m_knots[i + 1];
    return a.value + (b.value - a.value) * ((s - a.position) / (b.position - a.position));
  }

  /// Minimum and maximum over all channels and [low, high] (both ends included, and both sides of a
  /// step at either end).
  std::array<double, 2> range(double low, double high) const;

  const std::vector<Knot>& knots() const { return m_knots; }
  bool operator==(const PiecewiseLinear& other) const { return m_knots == other.m_knots; }
  /// Copy in which change(knot) was applied to each knot.
  template <typename Change>
  PiecewiseLinear withKnots(const Change& change) const {
    std::vector<Knot> knots = m_knots;
    std::ranges::for_each(knots, change);
    return PiecewiseLinear(std::move(knots));
  }
  /// Distance from the first to the last knot, in units of s.
  double span() const { return m_knots.back().position - m_knots.front().position; }

private:
  /// Segment i with position[i] <= s < position[i + 1], for s strictly between the outer knots. A
  /// table of equal bins gives the first candidate.
  std::size_t findSegment(double s) const {
    const auto bin = static_cast<std::size_t>((s - m_knots.front().position) * m_binsPerUnit);
    std::size_t i = m_firstSegment[std::min(bin, m_firstSegment.size() - 1)];
    while (s >= m_knots[i + 1].position)
      ++i;
    return i;
  }

  std::vector<Knot> m_knots;
  std::vector<std::uint32_t> m_firstSegment; ///< per bin: segment at or before its start
  double m_binsPerUnit = 0.0;
};

extern template class PiecewiseLinear<1>;
extern template class PiecewiseLinear<3>;

using ScalarFunction = PiecewiseLinear<1>;
using ColorFunction = PiecewiseLinear<3>;

} // namespace fenestra::core
