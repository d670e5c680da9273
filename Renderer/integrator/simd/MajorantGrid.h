#pragma once
// Majorants for lanes: 32 bits a cell. A cell stores its reach: to how many cells on every side the
// majorant holds. A lane leaves all of the reach in one step. Empty cells have the greatest reach,
// others as much as a looser majorant is worth: dense matter is walked cell by cell, thin matter in
// blocks. Cells of few voxels are merged, eight to one; between a cell that clipping removes and
// one that it leaves alone lies one that it cuts, as their bounds overlap (MajorantGrid::margin):
// what is merged of the two is cut.

#include "base/LargePages.h"
#include "integrator/scalar/MajorantGrid.h"

#include <cstdint>
#include <vector>

namespace fenestra {

struct SimdMajorants {
  /// Bits of a code: a float's upper bits are the majorant (mm^-1, rounded up; 0: empty cell), its
  /// sign says that the cell is cut (query keep), and its lowest bits are the reach.
  static constexpr std::int32_t radiusBits = 0xff, majorantBits = 0x7fffff00;
  static constexpr std::uint32_t cutBit = 1U << 31;
  static constexpr std::uint32_t maxRadius = 7; ///< of a cell that is not empty

  SimdMajorants() = default;
  explicit SimdMajorants(const MajorantGrid& majorants);

  std::int64_t merged = 1;     ///< cells of the MajorantGrid in a cell, along each axis
  Size3 count = Size3::Zero(); ///< cells, without the border
  /// Codes of all cells, with a border of empty cells.
  LargeArray<std::int32_t> codes;
};

} // namespace fenestra
