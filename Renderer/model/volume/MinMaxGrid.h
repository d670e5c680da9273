#pragma once
// Minimum and maximum of the scalar field in each cell of a coarse grid.

#include "model/volume/Volume.h"

namespace fenestra::core {

/// Cell c spans [c, c + 1] * cellSize() - 0.5 in index space, per axis. Its range covers every
/// voxel that trilinear interpolation in the cell can read, plus `padding` voxels on every side (1
/// for central differences).
class MinMaxGrid {
public:
  MinMaxGrid(const Volume& volume, int padding);

  /// Edges of a cell, voxels per axis. There are about 2^18 cells, as close to cubes in mm as whole
  /// voxels allow: in volumes with thick slices, long cells would have loose bounds.
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
  std::vector<float> m_low, m_high; ///< exact: float represents every voxel value
};

} // namespace fenestra::core
