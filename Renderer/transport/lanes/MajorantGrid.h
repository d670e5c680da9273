#pragma once
// The majorants as lanes walk them: 16 bits a cell, as lanes enter more cells than they fetch
// voxels and these should stay in the cache. A cell knows how far around it there is nothing, or
// its majorant holds, so that a lane leaves many cells in one step: all where it is empty, and
// elsewhere as many as a looser majorant is worth. Dense matter is walked cell by cell, thin matter
// in blocks.

#include "transport/readable/MajorantGrid.h"

#include <cstdint>
#include <vector>

namespace fenestra {

struct WideCells {
  /// Bits of a code of 0 and above, from the lowest: whether keep is to be asked, `reach` (3), and
  /// the majorant (11: a float's bits from the 17th on, counted from `bias`). 0 is an empty cell.
  static constexpr int reachBits = 3, majorantShift = 17;
  static constexpr std::uint32_t mostReach = (1U << reachBits) - 1;

  struct Cell {
    float majorant; ///< mm^-1, rounded up; 0 where the cell is empty
    std::uint32_t
        reach; ///< so many cells to every side, diagonals included, are bounded by it, too
    bool cut;  ///< clipping may remove part of it: ask keep
  };

  WideCells() = default;
  explicit WideCells(const MajorantGrid& majorants);

  /// Which the code says: what lanes do by themselves (WideTracker.cxx).
  Cell cell(std::size_t place) const;

  /// With a border of empty cells around them, and one more at the end, for lanes read two at a
  /// time. A negative code is the upper half of a float: the number of empty cells around an empty
  /// one, negated.
  std::vector<std::int16_t> codes;
  std::uint32_t bias = 0; ///< bits of a float
};

} // namespace fenestra
