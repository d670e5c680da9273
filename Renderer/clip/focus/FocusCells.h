#pragma once
// Sparse grid of a mask, and ray intersection with the surface of the mask: the level 1/2 of its
// indicator, the trilinear interpolation of its voxels (1 inside, 0 outside).

#include "model/volume/Mask.h"

#include <array>
#include <cstdint>
#include <vector>

namespace fenestra::core {

/// Rays that are traced together, in the cell space of FocusCells, as a structure of arrays.
struct FocusRays {
  static constexpr std::size_t capacity = 256;
  using SoaArray = std::array<double, capacity + 8>; ///< padded to full SIMD vectors

  /// Leaves the arrays uninitialized: clearing 256 entries costs more than tracing a few rays.
  FocusRays() {}

  std::size_t size = 0;
  alignas(64) std::array<SoaArray, 3> origin, direction;
  alignas(64) SoaArray begin, end; ///< interval of t to search; inside FocusCells::box()
  alignas(64) SoaArray hitT;       ///< first hit; infinity if the ray misses the mask
  /// Ray maximum: its t and its value. Set by findHitsAndMaxima, for rays that miss the mask.
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

/// Dual grid of a mask. Cell c lies between the voxel centers c - 1 and c of each axis and fills
/// [c, c + 1] of cell space; in the outermost cells the indicator falls to 0. Cells are stored in
/// blocks of 4^3: empty (no voxel above captureThreshold), full (all voxels >= 1/2) or mixed. A
/// mixed block has one byte per cell and fills one cache line.
class FocusCells {
public:
  static constexpr std::int64_t blockSize = 4; ///< cells

  /// Copies what it needs of `mask`. Throws Error (input) for a mask of more than 2^30 voxels.
  explicit FocusCells(const Mask& mask);

  const Affine& worldToCell() const { return m_worldToCell; }
  Affine cellToWorld() const { return m_worldToCell.inverse(); }
  /// Box of all cells, in cell space.
  Box box() const { return {Vec3::Zero(), m_count.cast<double>()}; }

  /// Sets rays.hitT: the first t in each ray's interval with indicator >= 1/2, or infinity.
  void findHits(FocusRays& rays) const;

  /// Sets rays.hitT and, for rays that miss the mask, the ray maximum: the first t at which the
  /// indicator is greatest. For a ray that barely misses, this is where it would hit the mask. If
  /// no indicator exceeds captureThreshold there is no ray maximum, and rays.maximum is
  /// captureThreshold. Of several local maxima (coplanar faces, a ridge along the ray) the nearer
  /// occludes the farther: one of value h2 replaces an earlier one of value h1 only if 1/2 - h2 <
  /// replaceRatio * (1/2 - h1).
  void findHitsAndMaxima(FocusRays& rays) const;
  static constexpr double captureThreshold = 0.25;
  static constexpr double replaceRatio = 1.0 / 64.0;

  /// Indicator at a point in cell space; 0 in empty blocks, 1 in full ones.
  double indicator(const Vec3& point) const;

  /// Arrays that the traversal reads.
  struct Layout {
    const std::int32_t* blocks;  ///< per block: its index into `corners` and `values`
    const std::uint8_t* corners; ///< BlockCorners, 64 bytes each
    Size3 blockCount;
    const std::uint8_t* values; ///< BlockValues, 128 bytes each; null: voxels are 0 and 1 only
    double valueScale;          ///< indicator per unit of a value
    std::size_t count;          ///< of BlockCorners and BlockValues
  };
  Layout layout() const;

  /// Calls visit(block) for each non-empty block. Block i fills [i, i + 1] * blockSize of cell
  /// space in each axis.
  template <typename Visitor>
  void visitOccupied(const Visitor& visit) const {
    std::size_t block = 0;
    for (std::int64_t z = 0; z < m_blocks.z(); ++z)
      for (std::int64_t y = 0; y < m_blocks.y(); ++y)
        for (std::int64_t x = 0; x < m_blocks.x(); ++x)
          if (m_blockCorners[block++] != emptyBlock)
            visit(Size3(x, y, z));
  }

  /// Calls visit(cell) for each cell of `block` with a corner above captureThreshold.
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
  /// One byte per cell of a block, x fastest. Bit i is set if corner i of the cell, x fastest, is
  /// above captureThreshold. Rays skip cells of value 0.
  using BlockCorners = std::array<std::uint8_t, blockSize * blockSize * blockSize>;
  static constexpr std::int32_t emptyBlock = 0, fullBlock = 1; ///< indices into m_corners
  /// Voxels at the corners of a block's cells, 5^3, x fastest, padded to two cache lines.
  using BlockValues = std::array<std::uint8_t, 128>;

  struct Block {
    BlockCorners corners;
    BlockValues values; ///< for smoothed masks only
  };
  std::vector<Block> buildLayer(const Mask& mask, std::int64_t z);
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

} // namespace fenestra::core
