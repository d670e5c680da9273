#pragma once
// A mask's cells, and where rays meet its surface in them.

#include "volume/Mask.h"

#include <array>
#include <cstdint>
#include <vector>

namespace fenestra {

/// Rays that are followed together, in the space of FocusCells; a structure of arrays.
struct FocusRays {
  static constexpr std::size_t capacity = 256;
  using Column = std::array<double, capacity + 8>; ///< and room for whole vectors

  std::size_t size = 0;
  alignas(64) std::array<Column, 3> origin{}, direction{};
  alignas(64) Column begin{}, end{}; ///< of the range that is looked at; it lies inside the cells
  alignas(64) Column meeting{};      ///< what was found

  bool full() const { return size == capacity; }
};

/// Dual cells: cell c lies between the voxel centres c - 1 and c of each axis, so that the
/// outermost cells hold the fall to 0 outside the mask's grid. In cell space it fills [c, c + 1].
/// Cells come in blocks of 4^3; a block that holds any of the mask, and not all, keeps one byte a
/// cell, so that a block is one line of the cache.
class FocusCells {
public:
  static constexpr std::int64_t blockSize = 4; ///< cells

  /// A view of a smoothed mask, which outlives it. Throws Error (input) for masks of more than 2^31
  /// voxels.
  explicit FocusCells(const Mask& mask);

  const Affine& worldToCell() const { return m_worldToCell; }
  Affine cellToWorld() const { return m_worldToCell.inverse(); }
  /// All cells.
  Box box() const { return {Vec3::Zero(), m_count.cast<double>()}; }

  /// The least t in each ray's range at which it is in the mask (indicator >= 0.5), else infinity.
  void findMeetings(FocusRays& rays) const;

  /// What walks read: of each block which corners it has, and these, 64 bytes each.
  struct Layout {
    const std::int32_t* blocks;
    const std::uint8_t* corners;
    Size3 blockCount;
    const Mask* smooth; ///< whose voxels say more than the corners; null where they do not
  };

  /// Calls back with each block, block (i, j, k) filling [i, i + 1]... of cell space / blockSize,
  /// that has a voxel of the mask at any corner of its cells.
  template <typename Visitor>
  void visitOccupied(const Visitor& visit) const {
    std::size_t block = 0;
    for (std::int64_t z = 0; z < m_blocks.z(); ++z)
      for (std::int64_t y = 0; y < m_blocks.y(); ++y)
        for (std::int64_t x = 0; x < m_blocks.x(); ++x)
          if (m_blockCorners[block++] != noBlock)
            visit(Size3(x, y, z));
  }

private:
  /// Of each cell of a block, x fastest, whether the indicator at its eight corners is at least
  /// 0.5, a bit each, x fastest. A cell without any is not met.
  using BlockCorners = std::array<std::uint8_t, blockSize * blockSize * blockSize>;
  static constexpr std::int32_t noBlock = 0, wholeBlock = 1; ///< blocks with all bits alike

  std::vector<BlockCorners> cornersOfLayer(const Mask& mask, std::int64_t z);

  Size3 m_count;  ///< cells
  Size3 m_blocks; ///< blocks of cells
  Affine m_worldToCell;
  std::vector<std::int32_t> m_blockCorners; ///< of each block, which of m_corners
  std::vector<BlockCorners> m_corners;
  const Mask* m_smooth = nullptr; ///< the mask itself, where its voxels are not 0 and 1 alone
};

} // namespace fenestra
