#pragma once
// Piecewise linear functions for lanes: in float, by segments instead of knots.

#include "model/medium/PiecewiseLinear.h"

#include <cstdint>
#include <vector>

namespace fenestra {

/// Segment i spans position[i] to position[i + 1], where a channel is value + slope (s -
/// position[i]); the first segment begins at -infinity, the last ends at infinity. Value and slope
/// are neighbours in memory: lanes load two floats at a time.
struct SimdTable {
  struct Line {
    float value, slope;
  };
  using Channel = std::vector<Line>;

  template <int Channels>
  explicit SimdTable(const PiecewiseLinear<Channels>& function);

  std::vector<float> position;
  std::vector<std::int32_t> binSegment; ///< first candidate of each equal bin, from binStart on
  float binStart, binsPerUnit;
  std::vector<Channel> channels;
};

extern template SimdTable::SimdTable(const PiecewiseLinear<1>&);
extern template SimdTable::SimdTable(const PiecewiseLinear<3>&);

/// Functions over equal bins, the same for all, so that one load serves lanes of different
/// functions: `count` lines of one function, then the next. Over a bin a line is value and rise,
/// then comes the value beyond. NaN rise: the bin holds a knot, ask the segments.
struct SimdLines {
  SimdLines() = default;
  explicit SimdLines(const std::vector<const ScalarFunction*>& functions);

  std::vector<SimdTable::Line> lines;
  std::vector<SimdTable> segments; ///< of each function
  float start = 0.0F;              ///< of the first bin
  float binsPerUnit = 0.0F;        ///< bins; 0: none have a width that floats can tell
  std::int32_t count = 0;
  float last = 0.0F; ///< count - 1
};

} // namespace fenestra
