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
  std::vector<float> position;
  std::vector<std::int32_t> binSegment; ///< first candidate of each equal bin, from binStart on
  float binStart = 0.0F, binsPerUnit = 0.0F;
  std::vector<Channel> channels;
  /// The first channel in equal bins from binStart on, each a line over the bin: value, and rise
  /// over the bin; then the value beyond. NaN rise: the bin holds a knot, ask the segments.
  std::vector<Line> lines;
  float linesPerUnit = 0.0F, lastLine = 0.0F;

  WideTable() = default;
  template <int Channels>
  explicit WideTable(const PiecewiseLinear<Channels>& function);
};

extern template WideTable::WideTable(const PiecewiseLinear<1>&);
extern template WideTable::WideTable(const PiecewiseLinear<3>&);

} // namespace fenestra
