#include "model/medium/PiecewiseLinear.h"

#include <cassert>

namespace fenestra::core {

template <int Channels>
PiecewiseLinear<Channels>::PiecewiseLinear(std::vector<Knot> knots) : m_knots(std::move(knots)) {
  assert(!m_knots.empty());
  std::stable_sort(m_knots.begin(), m_knots.end(),
                   [](const Knot& a, const Knot& b) { return a.position < b.position; });
  if (!(span() > 0.0))
    return; // one position: every value is that of an end

  const std::size_t bins = 4 * m_knots.size();
  m_binsPerUnit = static_cast<double>(bins) / span();
  if (!std::isfinite(m_binsPerUnit))
    m_binsPerUnit = 0.0; // subnormal span: a single bin
  m_firstSegment.resize(bins);
  std::size_t i = 0;
  for (std::size_t bin = 0; bin < bins; ++bin) {
    // One bin early: rounding of s to a bin must never lead past the segment of s.
    const double start =
        m_knots.front().position + (static_cast<double>(bin) - 1.0) / m_binsPerUnit;
    while (i + 2 < m_knots.size() && m_knots[i + 1].position <= start)
      ++i;
    m_firstSegment[bin] = static_cast<std::uint32_t>(i);
  }
}

template <int Channels>
std::array<double, 2> PiecewiseLinear<Channels>::range(double low, double high) const {
  const auto atLow = (*this)(low);
  const auto atHigh = (*this)(high);
  double least = std::min(atLow.minCoeff(), atHigh.minCoeff());
  double greatest = std::max(atLow.maxCoeff(), atHigh.maxCoeff());
  auto knot = std::lower_bound(m_knots.begin(), m_knots.end(), low,
                               [](const Knot& k, double s) { return k.position < s; });
  for (; knot != m_knots.end() && knot->position <= high; ++knot) {
    least = std::min(least, knot->value.minCoeff());
    greatest = std::max(greatest, knot->value.maxCoeff());
  }
  return {least, greatest};
}

template class PiecewiseLinear<1>;
template class PiecewiseLinear<3>;

} // namespace fenestra::core
