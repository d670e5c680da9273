#pragma once
// Majorants for lanes: 16 bits a cell, so that cells stay in the cache, as lanes enter more cells
// than they fetch voxels. A cell stores its reach: to how many cells on every side the majorant
// holds. A lane leaves all of the reach in one step. Empty cells have the greatest reach, others as
// much as a looser majorant is worth: dense matter is walked cell by cell, thin matter in blocks.

#include "transport/readable/MajorantGrid.h"

#include <cstdint>
#include <vector>

namespace fenestra {

struct WideCells {
  /// Bits of a code > 0, from the lowest: cut (1), reach (3), majorant (11: a float's bits from bit
  /// 17 on, less `bias`). Code 0: an empty cell of reach 0.
  static constexpr int reachBits = 3, majorantShift = 17;
  static constexpr std::uint32_t mostReach = (1U << reachBits) - 1;

  struct Cell {
    float majorant;      ///< mm^-1, rounded up; 0: empty cell
    std::uint32_t reach; ///< cells to every side, diagonals included, with the same bound
    bool cut;            ///< clipping may remove part of the cell: query keep
  };

  WideCells() = default;
  explicit WideCells(const MajorantGrid& majorants);

  /// Decodes codes[place]; lanes have a decoder of their own (WideTracker.cxx).
  Cell cell(std::size_t place) const;

  /// Codes of all cells, with a border of empty cells, and one code more at the end, as lanes read
  /// two at a time. A negative code is the upper half of a float: -reach of an empty cell.
  std::vector<std::int16_t> codes;
  std::uint32_t bias = 0; ///< float bits, subtracted from a majorant's
};

} // namespace fenestra
