#pragma once
// The least and greatest scalar that the continuous field takes in each cell of a coarse grid.

#include "model/volume/Volume.h"

namespace fenestra {

/// Cell c spans [c, c + 1] * edge - 0.5 in index space, in each axis. The cell's range covers every
/// voxel that trilinear interpolation inside the cell can touch, plus `apron` voxels on every side
/// (1 for central differences).
class MinMaxGrid {
public:
  MinMaxGrid(const Volume& volume, int padding);

  /// Edges of a cell, voxels per axis. About 2^18 cells, as near to cubes in mm as whole voxels
  /// allow: thick slices must not make long cells with loose bounds.
  static Size3 chooseCellSize(const Grid& grid);

  int padding() const { return m_padding; }
  const Size3& cellSize() const { return m_cellSize; }
  const Size3& cellCount() const { return m_cellCount; }
  std::size_t size() const { return m_low.size(); }
  double low(std::size_t cell) const { return m_low[cell]; }
  double high(std::size_t cell) const { return m_high[cell]; }

private:
  template <typename Voxel>
  void fill(const Grid& grid, const LargeArray<Voxel>& voxels);

  int m_padding;
  Size3 m_cellSize, m_cellCount;
  std::vector<float> m_low, m_high; ///< exact: every storage type fits a float
};

} // namespace fenestra
