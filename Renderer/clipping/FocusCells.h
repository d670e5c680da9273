#pragma once
// A mask's cells, and where rays meet its surface in them.

#include "volume/Mask.h"

#include <cstdint>
#include <vector>

namespace fenestra {

/// Dual cells: cell c lies between the voxel centres c - 1 and c of each axis, so that the
/// outermost cells hold the fall to 0 outside the mask's grid. In cell space it fills [c, c + 1].
/// Blocks of cells are the unit in which empty ones are left out. The mask has to stay alive.
class FocusCells {
public:
  static constexpr std::int64_t blockSize = 4; ///< cells

  explicit FocusCells(const Mask& mask);

  Affine cellToWorld() const { return m_worldToCell.inverse(); }

  /// The least t in the range at which a world ray is in the mask (indicator >= 0.5), else
  /// infinity.
  double firstMeeting(const Ray& world, const Interval& range) const;

  /// Calls back with each block, block (i, j, k) filling [i, i + 1]... of cell space / blockSize,
  /// that has a voxel of the mask at any corner of its cells.
  template <typename Visitor>
  void visitOccupied(const Visitor& visit) const {
    std::size_t block = 0;
    for (std::int64_t z = 0; z < m_blocks.z(); ++z)
      for (std::int64_t y = 0; y < m_blocks.y(); ++y)
        for (std::int64_t x = 0; x < m_blocks.x(); ++x)
          if (m_occupied[block++])
            visit(Size3(x, y, z));
  }

private:
  void markBlocks();
  bool isOccupied(std::int64_t block) const { return m_occupied[static_cast<std::size_t>(block)]; }
  double meetingInCells(const Ray& ray, const Interval& range) const;
  unsigned cornerBits(const Size3& cell) const;
  const std::uint8_t* row(std::int64_t y, std::int64_t z) const {
    return m_voxels + m_size.x() * (y + m_size.y() * z);
  }

  const std::uint8_t* m_voxels;
  Size3 m_size;   ///< voxels
  Size3 m_count;  ///< cells
  Size3 m_blocks; ///< blocks of cells
  Affine m_worldToCell;
  std::vector<std::uint8_t> m_occupied;
};

} // namespace fenestra
