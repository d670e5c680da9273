#pragma once
// A piecewise linear function as lanes read it: in float, each segment by itself.

#include "model/medium/PiecewiseLinear.h"

#include <cstdint>
#include <vector>

namespace fenestra {

/// In segment i a channel is value + slope (s - position[i]), from position[i] to position[i + 1];
/// the first segment begins at -infinity, the last has no end. What is wanted together lies
/// together: lanes take two floats at a time.
struct WideTable {
  struct Line {
    float value, slope;
  };
  using Channel = std::vector<Line>;
  std::vector<float> position;
  std::vector<std::int32_t> binSegment; ///< for equal bins from binStart on: the first candidate
  float binStart = 0.0F, binsPerUnit = 0.0F;
  std::vector<Channel> channels;

  WideTable() = default;
  template <int Channels>
  explicit WideTable(const PiecewiseLinear<Channels>& function);
};

extern template WideTable::WideTable(const PiecewiseLinear<1>&);
extern template WideTable::WideTable(const PiecewiseLinear<3>&);

} // namespace fenestra
