#include "model/volume/MinMaxGrid.h"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace fenestra::core {
namespace {

struct Span {
  std::int64_t first, last; ///< voxels, both included
};

/// Voxels that interpolation in cell `c` of one axis can read.
Span findFootprint(std::int64_t c, std::int64_t cellSize, std::int64_t voxels, int padding) {
  const std::int64_t first = c * cellSize - 1 - padding;
  const std::int64_t last = (c + 1) * cellSize + padding;
  return {std::max<std::int64_t>(first, 0), std::min(last, voxels - 1)};
}

/// Element-wise minimum and maximum of `lows`, `highs` and a row of voxels.
template <typename Voxel>
void addRow(const Voxel* row, std::vector<Voxel>& lows, std::vector<Voxel>& highs) {
  Voxel* const low = lows.data();
  Voxel* const high = highs.data();
  for (std::size_t i = 0; i < lows.size(); ++i) {
    low[i] = std::min(low[i], row[i]);
    high[i] = std::max(high[i], row[i]);
  }
}

} // namespace

MinMaxGrid::MinMaxGrid(const Volume& volume, int padding)
    : m_padding(padding),
      m_cellSize(chooseCellSize(volume.grid)),
      m_cellCount((volume.grid.size.array() + m_cellSize.array() - 1) / m_cellSize.array()),
      m_low(static_cast<std::size_t>(m_cellCount.prod())),
      m_high(m_low.size()) {
  std::visit([&](const auto& voxels) { fill(volume.grid, voxels); }, volume.voxels);
}

Size3 MinMaxGrid::chooseCellSize(const Grid& grid) {
  constexpr double wantedCells = 1 << 18;
  const Vec3 spacing = grid.spacing();
  const Vec3 size = grid.size.cast<double>();
  Vec3 voxels = Vec3::Zero(); // 0: not yet determined
  // An axis with spacing > the cube's edge gets cells of one voxel; an axis shorter than the edge
  // gets one cell. The other axes divide the remaining cells. (Otherwise a thin slice would have a
  // cell per voxel.)
  for (int settled = 0; settled < 3; ++settled) {
    double volume = 1.0; // product of the undetermined axes' lengths
    double cells = wantedCells;
    for (int axis = 0; axis < 3; ++axis)
      if (voxels[axis] == 0.0)
        volume *= spacing[axis] * size[axis];
      else
        cells /= size[axis] / voxels[axis];
    const double edge = std::pow(volume / cells, 1.0 / (3 - settled)); // mm
    int farthest = -1;
    double factor = 0.0; // ratio by which the cells of `farthest` differ from the cube's edge
    for (int axis = 0; axis < 3; ++axis)
      if (voxels[axis] == 0.0) {
        const double cube = edge / spacing[axis];
        const double miss = std::max(1.0 / cube, cube / size[axis]);
        if (farthest < 0 || miss > factor) {
          farthest = axis;
          factor = miss;
        }
      }
    voxels[farthest] =
        std::max(1.0, std::min(std::round(edge / spacing[farthest]), size[farthest]));
  }
  return voxels.cast<std::int64_t>();
}

template <typename Voxel>
void MinMaxGrid::fill(const Grid& grid, const LargeArray<Voxel>& voxels) {
  // Each row of cells is first reduced to one row of voxels, element-wise. This reads memory in
  // order and with vector instructions.
  const auto fillSlab = [&](std::int64_t cz) {
    const Span z = findFootprint(cz, m_cellSize.z(), grid.size.z(), m_padding);
    std::vector<Voxel> low(static_cast<std::size_t>(grid.size.x())), high(low.size());
    for (std::int64_t cy = 0; cy < m_cellCount.y(); ++cy) {
      const Span y = findFootprint(cy, m_cellSize.y(), grid.size.y(), m_padding);
      std::ranges::fill(low, std::numeric_limits<Voxel>::max());
      std::ranges::fill(high, std::numeric_limits<Voxel>::lowest());
      for (std::int64_t k = z.first; k <= z.last; ++k)
        for (std::int64_t j = y.first; j <= y.last; ++j)
          addRow(voxels.data() + grid.size.x() * (j + grid.size.y() * k), low, high);
      for (std::int64_t cx = 0; cx < m_cellCount.x(); ++cx) {
        const auto [first, last] = findFootprint(cx, m_cellSize.x(), grid.size.x(), m_padding);
        const std::size_t cell = linearIndex({cx, cy, cz}, m_cellCount);
        m_low[cell] =
            static_cast<float>(*std::min_element(low.begin() + first, low.begin() + last + 1));
        m_high[cell] =
            static_cast<float>(*std::max_element(high.begin() + first, high.begin() + last + 1));
      }
    }
  };
  tbb::parallel_for(std::int64_t{0}, m_cellCount.z(), fillSlab);
}

} // namespace fenestra::core
