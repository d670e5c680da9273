#pragma once
// Majorants in SIMD form: 32 bits per cell. Besides its majorant a cell stores a skip radius: the
// number of cells on every side for which the majorant holds, so that a ray leaves them all in one
// step. Empty cells have the largest possible radius; others trade a looser majorant for a longer
// step: dense regions are traversed cell by cell, sparse ones in blocks. Small cells are merged,
// eight to one. Bounds overlap (MajorantGrid::margin), so that between a removed and an uncut cell
// there is always a cut one. A merged cell that the surface crosses is therefore cut.

#include "base/LargePages.h"
#include "integrator/scalar/MajorantGrid.h"

#include <cstdint>
#include <vector>

namespace fenestra::core {

struct SimdMajorants {
  /// Fields of a code: a float's upper bits are the majorant (mm^-1, rounded up; 0: empty). Its
  /// sign marks a cut cell (evaluate the clip weight). Its lowest bits are the skip radius.
  static constexpr std::int32_t radiusBits = 0xff, majorantBits = 0x7fffff00;
  static constexpr std::uint32_t cutBit = 1U << 31;
  static constexpr std::uint32_t maxRadius = 7; ///< skip radius of a cell that is not empty

  SimdMajorants() = default;
  explicit SimdMajorants(const MajorantGrid& majorants);

  std::int64_t merged = 1;     ///< cells of the MajorantGrid per cell, along each axis
  Size3 count = Size3::Zero(); ///< cells, without the border
  /// Codes of all cells, surrounded by a border of empty cells.
  LargeArray<std::int32_t> codes;
};

} // namespace fenestra::core
