#pragma once
// The least and greatest scalar that the continuous field takes in each cell of a coarse grid.

#include "model/volume/Volume.h"

namespace fenestra {

/// Cell c spans [c, c + 1] * edge voxels in each axis, counted from the volume's corner: index
/// space from c * edge - 0.5 on. Its range covers every voxel that trilinear interpolation inside
/// it can touch, plus `apron` voxels more to every side (1 for central differences).
class CellRanges {
public:
  CellRanges(const Volume& volume, int apron);

  /// Voxels that a cell spans: cells are as near to cubes in mm as whole voxels allow, and about
  /// a quarter of a million of them, so that thick slices do not make long cells with loose bounds.
  static Size3 edgeFor(const Grid& grid);

  int apron() const { return m_apron; }
  const Size3& edge() const { return m_edge; }
  const Size3& cellCount() const { return m_cellCount; }
  std::size_t size() const { return m_low.size(); }
  double low(std::size_t cell) const { return m_low[cell]; }
  double high(std::size_t cell) const { return m_high[cell]; }

private:
  template <typename Voxel>
  void fill(const Grid& grid, const std::vector<Voxel>& voxels);

  int m_apron;
  Size3 m_edge, m_cellCount;
  std::vector<float> m_low, m_high; ///< exact: every storage type fits a float
};

} // namespace fenestra
