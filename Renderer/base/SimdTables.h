#pragma once
// Tables that move lanes within a vector. They stay in static memory, whereas Highway 1.0.3 copies
// its table for Compress to the stack at each call.

#include <array>
#include <cstdint>

namespace fenestra::core {

/// Per set of eight lanes: eight indices of one byte each, the first in the lowest byte.
using LaneTable = std::array<std::uint64_t, 256>;

/// Indices of the lanes in the set, ascending; then zeros.
constexpr LaneTable makePackTable() {
  LaneTable table{};
  for (std::uint64_t set = 0; set < table.size(); ++set) {
    int count = 0;
    for (std::uint64_t lane = 0; lane < 8; ++lane)
      if ((set >> lane & 1) != 0)
        table[set] |= lane << 8 * count++;
  }
  return table;
}

/// Number of lanes of the set before each lane.
constexpr LaneTable makeRankTable() {
  LaneTable table{};
  for (std::uint64_t set = 0; set < table.size(); ++set) {
    std::uint64_t rank = 0;
    for (std::uint64_t lane = 0; lane < 8; ++lane) {
      table[set] |= rank << 8 * lane;
      rank += set >> lane & 1;
    }
  }
  return table;
}

inline constexpr LaneTable lanePackTable = makePackTable(), laneRankTable = makeRankTable();

} // namespace fenestra::core
