#pragma once
// Cells of a mask, and the points at which rays meet the mask's surface in its cells.

#include "model/volume/Mask.h"

#include <array>
#include <cstdint>
#include <vector>

namespace fenestra {

/// Rays traced together, in the cell space of FocusCells; a structure of arrays.
struct FocusRays {
  static constexpr std::size_t capacity = 256;
  using SoaArray = std::array<double, capacity + 8>; ///< padded to whole vectors

  /// Leaves the arrays uninitialised: clearing 256 entries costs more than tracing a few rays.
  FocusRays() {}

  std::size_t size = 0;
  alignas(64) std::array<SoaArray, 3> origin, direction;
  alignas(64) SoaArray begin, end; ///< range of t to search; inside FocusCells::box()
  alignas(64) SoaArray hitT;       ///< t at which the mask is met; infinity: missed
  /// Summit's t, and the indicator there; only from findHitsAndMaxima, for rays that miss the mask.
  alignas(64) SoaArray maximumT, maximum;

  bool isFull() const { return size == capacity; }

  void add(const Ray& ray, const Interval& range) {
    for (int axis = 0; axis < 3; ++axis) {
      origin[static_cast<std::size_t>(axis)][size] = ray.origin[axis];
      direction[static_cast<std::size_t>(axis)][size] = ray.direction[axis];
    }
    begin[size] = range.begin;
    end[size++] = range.end;
  }
};

/// Dual cells: cell c lies between the voxel centres c - 1 and c of each axis and fills [c, c + 1]
/// of cell space; the outermost cells hold the fall to 0 outside the mask's grid. Cells come in
/// blocks of 4^3: empty (no voxel above the foothill), whole (all voxels >= 1/2) or mixed. A mixed
/// block keeps one byte a cell, one line of the cache in all.
class FocusCells {
public:
  static constexpr std::int64_t blockSize = 4; ///< cells

  /// Keeps no reference to `mask`. Throws Error (input) for a mask of more than 2^30 voxels.
  explicit FocusCells(const Mask& mask);

  const Affine& worldToCell() const { return m_worldToCell; }
  Affine cellToWorld() const { return m_worldToCell.inverse(); }
  /// Box of all cells, in cell space.
  Box box() const { return {Vec3::Zero(), m_count.cast<double>()}; }

  /// Fills rays.meeting: least t in each ray's range with indicator >= 1/2; infinity: none.
  void findHits(FocusRays& rays) const;

  /// Fills rays.meeting and, for rays that miss the mask, rays.summit and rays.height. Summit:
  /// least t at which the indicator is greatest, for a ray that just misses the mask the t at which
  /// the ray would meet the mask. Height: indicator there; `foothill`: no summit (indicator <=
  /// foothill). With several hills on a ray (faces in one plane, a ridge along the ray) the nearer
  /// hides the farther: (1) the summit is the top of the first hill above the foothill; (2) a later
  /// hill of height h2 replaces a summit of height h1 only if 1/2 - h2 < replaceRatio * (1/2 - h1).
  void findHitsAndMaxima(FocusRays& rays) const;
  static constexpr double captureThreshold = 0.25;
  static constexpr double replaceRatio = 1.0 / 64.0;

  /// Indicator at a point of cell space; 0 all over empty blocks, 1 all over whole ones.
  double indicator(const Vec3& point) const;

  /// Arrays that the walks read.
  struct Layout {
    const std::int32_t* blocks;  ///< per block: its number in `corners` and `values`
    const std::uint8_t* corners; ///< BlockCorners, 64 bytes each
    Size3 blockCount;
    const std::uint8_t* values; ///< BlockValues, 128 bytes each; null: voxels are 0 and 1 only
    double valueScale;          ///< indicator per unit of a value
  };

  /// Calls back with each block that is not empty; block (i, j, k) fills [i, i + 1]... of cell
  /// space / blockSize.
  template <typename Visitor>
  void visitOccupied(const Visitor& visit) const {
    std::size_t block = 0;
    for (std::int64_t z = 0; z < m_blocks.z(); ++z)
      for (std::int64_t y = 0; y < m_blocks.y(); ++y)
        for (std::int64_t x = 0; x < m_blocks.x(); ++x)
          if (m_blockCorners[block++] != emptyBlock)
            visit(Size3(x, y, z));
  }

  /// Calls back with each cell of `block` that has a corner above the foothill.
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
  /// One byte per cell of a block, x fastest; bit i is set if corner i of the cell, x fastest, is
  /// above the foothill. 0: the walks skip the cell.
  using BlockCorners = std::array<std::uint8_t, blockSize * blockSize * blockSize>;
  static constexpr std::int32_t emptyBlock = 0, fullBlock = 1; ///< numbers in m_corners
  /// Voxels at the corners of a block's cells, 5^3, x fastest, padded to two lines of the cache.
  using BlockValues = std::array<std::uint8_t, 128>;

  struct Block {
    BlockCorners corners;
    BlockValues values; ///< of a smoothed mask only
  };
  std::vector<Block> buildLayer(const Mask& mask, std::int64_t z);
  Layout layout() const;
  std::int64_t blockIndex(const Size3& block) const {
    return block.x() + m_blocks.x() * (block.y() + m_blocks.y() * block.z());
  }

  Size3 m_count;  ///< cells
  Size3 m_blocks; ///< blocks of cells
  Affine m_worldToCell;
  std::vector<std::int32_t> m_blockCorners; ///< per block: index into m_corners
  std::vector<BlockCorners> m_corners;
  std::vector<BlockValues> m_values; ///< parallel to m_corners; empty: voxels are 0 and 1 only
  double m_valueScale;
};

} // namespace fenestra
