#pragma once
// Piecewise linear functions in SIMD form: float, segments instead of knots.

#include "model/medium/PiecewiseLinear.h"

#include <cstdint>
#include <vector>

namespace fenestra::core {

/// Segment i spans position[i] to position[i + 1]; there a channel is value + slope (s -
/// position[i]). The first segment starts at -infinity, the last ends at infinity. Value and slope
/// are adjacent in memory, since SIMD code loads two floats at a time.
struct SimdTable {
  struct Line {
    float value, slope;
  };
  using Channel = std::vector<Line>;

  template <int Channels>
  explicit SimdTable(const PiecewiseLinear<Channels>& function);

  std::vector<float> position;
  std::vector<std::int32_t> binSegment; ///< first candidate per equal bin, from binStart on
  float binStart, binsPerUnit;
  std::vector<Channel> channels;
};

extern template SimdTable::SimdTable(const PiecewiseLinear<1>&);
extern template SimdTable::SimdTable(const PiecewiseLinear<3>&);

/// Functions over the same equal bins, so that one load serves lanes of different functions:
/// `count` lines of one function, then those of the next. A line is value and rise over its bin; a
/// function's last line is its value beyond the bins. A rise of NaN marks a bin with a knot inside:
/// use the segments there.
struct SimdLines {
  SimdLines() = default;
  explicit SimdLines(const std::vector<const ScalarFunction*>& functions);

  std::vector<SimdTable::Line> lines;
  std::vector<SimdTable> segments; ///< one table per function
  float start = 0.0F;              ///< of the first bin
  float binsPerUnit = 0.0F;        ///< bins per scalar unit; 0: too narrow for float, no bins
  std::int32_t count = 0;          ///< lines per function
  float last = 0.0F;               ///< count - 1
};

} // namespace fenestra::core
