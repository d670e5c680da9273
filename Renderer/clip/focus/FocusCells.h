#pragma once
// A mask's cells, and where rays meet its surface in them.

#include "model/volume/Mask.h"

#include <array>
#include <cstdint>
#include <vector>

namespace fenestra {

/// Rays that are followed together, in the space of FocusCells; a structure of arrays.
struct FocusRays {
  static constexpr std::size_t capacity = 256;
  using Column = std::array<double, capacity + 8>; ///< and room for whole vectors

  FocusRays() {} // its columns are not cleared: a few rays cost no more than a few rays

  std::size_t size = 0;
  alignas(64) std::array<Column, 3> origin, direction;
  alignas(64) Column begin, end; ///< of the range that is looked at; it lies inside the cells
  alignas(64) Column meeting;    ///< what was found
  /// Of rays that meet nothing, as findSummits finds it.
  alignas(64) Column summit, height;

  bool full() const { return size == capacity; }
};

/// Dual cells: cell c lies between the voxel centres c - 1 and c of each axis, so that the
/// outermost cells hold the fall to 0 outside the mask's grid. In cell space it fills [c, c + 1].
/// Cells come in blocks of 4^3; a block that holds any of the mask, and not all, keeps one byte a
/// cell, so that a block is one line of the cache.
class FocusCells {
public:
  static constexpr std::int64_t blockSize = 4; ///< cells

  /// Of a mask, which it needs no more. Throws Error (input) for one of more than 2^30 voxels.
  explicit FocusCells(const Mask& mask);

  const Affine& worldToCell() const { return m_worldToCell; }
  Affine cellToWorld() const { return m_worldToCell.inverse(); }
  /// All cells.
  Box box() const { return {Vec3::Zero(), m_count.cast<double>()}; }

  /// The least t in each ray's range at which it is in the mask (indicator >= 0.5), else infinity.
  void findMeetings(FocusRays& rays) const;

  /// The same, and of rays that meet nothing the t of their summit, where the indicator is greatest
  /// (the least such t), and how high it is there; no summit is known where it is `foothill` or
  /// less, and its height is `foothill`. Where a ray just misses the mask its summit is where it
  /// would meet it. Where it just misses two parts, as faces in one plane or a ridge along it, the
  /// nearer one hides the other: a summit is left for one behind it only if that lacks less than a
  /// share of what it lacks itself of 1/2.
  void findSummits(FocusRays& rays) const;
  static constexpr double foothill = 0.25;
  static constexpr double lessHidden = 1.0 / 64.0;

  /// The indicator at a point of the cells' space; 0 in cells without a voxel above the foothill.
  double indicator(const Vec3& point) const;

  /// What walks read: of each block which corners it has, and these, 64 bytes each.
  struct Layout {
    const std::int32_t* blocks;
    const std::uint8_t* corners;
    Size3 blockCount;
    const std::uint8_t* values; ///< of each block's voxels; null where the corners say it all
    double perValue;            ///< indicator
  };

  /// Calls back with each block, block (i, j, k) filling [i, i + 1]... of cell space / blockSize,
  /// that has a voxel above the foothill at any corner of its cells.
  template <typename Visitor>
  void visitOccupied(const Visitor& visit) const {
    std::size_t block = 0;
    for (std::int64_t z = 0; z < m_blocks.z(); ++z)
      for (std::int64_t y = 0; y < m_blocks.y(); ++y)
        for (std::int64_t x = 0; x < m_blocks.x(); ++x)
          if (m_blockCorners[block++] != noBlock)
            visit(Size3(x, y, z));
  }

  /// Calls back with each cell of a block that has a voxel above the foothill at any corner.
  template <typename Visitor>
  void visitCells(const Size3& block, const Visitor& visit) const {
    const BlockCorners& corners = m_corners[static_cast<std::size_t>(
        m_blockCorners[static_cast<std::size_t>(blockIndex(block))])];
    std::size_t cell = 0;
    for (std::int64_t z = 0; z < blockSize; ++z)
      for (std::int64_t y = 0; y < blockSize; ++y)
        for (std::int64_t x = 0; x < blockSize; ++x)
          if (corners[cell++] != 0)
            visit(Size3(blockSize * block + Size3(x, y, z)));
  }

private:
  /// Of each cell of a block, x fastest, whether the indicator at its eight corners is above the
  /// foothill, a bit each, x fastest. A cell without any is not met.
  using BlockCorners = std::array<std::uint8_t, blockSize * blockSize * blockSize>;
  static constexpr std::int32_t noBlock = 0, wholeBlock = 1; ///< with none of the mask, and only it
  /// The voxels around the cells of a block, x fastest, and what makes them two lines of the cache.
  using BlockValues = std::array<std::uint8_t, 128>;

  struct Block {
    BlockCorners corners;
    BlockValues values; ///< of a smoothed mask only
  };
  std::vector<Block> blocksOfLayer(const Mask& mask, std::int64_t z);
  Layout layout() const;
  std::int64_t blockIndex(const Size3& block) const {
    return block.x() + m_blocks.x() * (block.y() + m_blocks.y() * block.z());
  }

  Size3 m_count;  ///< cells
  Size3 m_blocks; ///< blocks of cells
  Affine m_worldToCell;
  std::vector<std::int32_t> m_blockCorners; ///< of each block, which of m_corners
  std::vector<BlockCorners> m_corners;
  std::vector<BlockValues> m_values; ///< as m_corners; empty where voxels are 0 and 1 alone
  double m_perValue;
};

} // namespace fenestra
