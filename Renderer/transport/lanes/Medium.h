#pragma once
// A piecewise linear function for lanes: in float, by segments instead of knots.

#include "model/medium/PiecewiseLinear.h"

#include <cstdint>
#include <vector>

namespace fenestra {

/// Segment i spans position[i] to position[i + 1], where a channel is value + slope (s -
/// position[i]); the first segment begins at -infinity, the last ends at infinity. Value and slope
/// are neighbours in memory: lanes load two floats at a time.
struct WideTable {
  struct Line {
    float value, slope;
  };
  using Channel = std::vector<Line>;

  /// Equal bins from the scalar `low` to `high`.
  struct Bins {
    double start, end;
    float perUnit; ///< bins; 0: none have a width that floats can tell

    Bins(double low, double high);
    /// The first channel over the bins, each a line: value, and rise over the bin; then the value
    /// beyond. NaN rise: the bin holds a knot, ask the segments.
    template <int Channels>
    std::vector<Line> linesOf(const PiecewiseLinear<Channels>& function) const;
  };

  std::vector<float> position;
  std::vector<std::int32_t> binSegment; ///< first candidate of each equal bin, from binStart on
  float binStart = 0.0F, binsPerUnit = 0.0F;
  std::vector<Channel> channels;
  std::vector<Line> lines; ///< of Bins over all knots, from binStart on
  float linesPerUnit = 0.0F, lastLine = 0.0F;

  WideTable() = default;
  template <int Channels>
  explicit WideTable(const PiecewiseLinear<Channels>& function);
};

extern template WideTable::WideTable(const PiecewiseLinear<1>&);
extern template WideTable::WideTable(const PiecewiseLinear<3>&);
extern template std::vector<WideTable::Line>
WideTable::Bins::linesOf(const PiecewiseLinear<1>&) const;

} // namespace fenestra
