#pragma once
// The least and greatest scalar that the continuous field takes in each cell of a coarse grid.

#include "volume/Volume.h"

namespace fenestra {

/// Cell c spans [c, c + 1] * edge voxels, counted from the volume's corner: index space from
/// c * edge - 0.5 on. Its range covers every voxel that trilinear interpolation inside it can
/// touch, plus `apron` voxels more to every side (1 for central differences).
class CellRanges {
public:
  static constexpr int edge = 8; ///< voxels; 4 is as fast at eight times the memory, 16 is 10 to 40 % slower

  CellRanges(const Volume& volume, int apron);

  const Size3& cellCount() const { return m_cellCount; }
  std::size_t size() const { return m_low.size(); }
  double low(std::size_t cell) const { return m_low[cell]; }
  double high(std::size_t cell) const { return m_high[cell]; }

private:
  template <typename Voxel>
  void fill(const Grid& grid, const std::vector<Voxel>& voxels, int apron);

  Size3 m_cellCount;
  std::vector<float> m_low, m_high; ///< exact: every storage type fits a float
};

} // namespace fenestra
