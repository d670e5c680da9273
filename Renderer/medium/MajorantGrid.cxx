#include "medium/MajorantGrid.h"

#include <tbb/parallel_for.h>

namespace fenestra {
namespace {

/// The transfer function's maximum over [low, high], widened by what interpolating between two
/// values of that size can round to.
double greatest(const ScalarFunction& f, double low, double high) {
  const double rounding =
      4.0 * std::numeric_limits<double>::epsilon() * std::max(std::abs(low), std::abs(high));
  return f.range(low - rounding, high + rounding)[1];
}

/// Greatest |gradient| (scalar units per mm) where all interpolated values differ by at most
/// `spread`: every central difference is at most half of it a voxel.
double gradientBound(const Grid& grid, double spread) {
  return 0.5 * spread * grid.worldToIndex.linear().rowwise().norm().sum();
}

std::array<Vec3, 8> corners(const Affine& cellToWorld, const Vec3& cell) {
  std::array<Vec3, 8> points;
  const Box box{cell, cell.array() + 1.0};
  for (int i = 0; i < 8; ++i)
    points[static_cast<std::size_t>(i)] = cellToWorld * box.corner(i);
  return points;
}

} // namespace

MajorantGrid::MajorantGrid(const Grid& grid, const CellRanges& ranges,
                           const TransferFunction& transfer, const Removed& removed)
    : m_cellCount(ranges.cellCount()), m_majorants(ranges.size()) {
  m_worldToCell = Eigen::Scaling(1.0 / CellRanges::edge) *
                  (Eigen::Translation3d(Vec3::Constant(0.5)) * grid.worldToIndex);
  const Affine cellToWorld = m_worldToCell.inverse();

  tbb::parallel_for(std::int64_t{0}, m_cellCount.z(), [&](std::int64_t z) {
    for (std::int64_t y = 0; y < m_cellCount.y(); ++y)
      for (std::int64_t x = 0; x < m_cellCount.x(); ++x) {
        const auto cell = static_cast<std::size_t>(x + m_cellCount.x() * (y + m_cellCount.y() * z));
        const double low = ranges.low(cell);
        const double high = ranges.high(cell);
        double majorant = greatest(transfer.extinction, low, high);
        if (majorant > 0.0 && transfer.gradientOpacity)
          majorant *= greatest(*transfer.gradientOpacity, 0.0, gradientBound(grid, high - low));
        if (majorant > 0.0 && removed(corners(cellToWorld, Size3(x, y, z).cast<double>())))
          majorant = 0.0;
        m_majorants[cell] = majorant;
      }
  });
}

double MajorantGrid::emptyFraction() const {
  const auto empty = std::count(m_majorants.begin(), m_majorants.end(), 0.0);
  return static_cast<double>(empty) / static_cast<double>(m_majorants.size());
}

} // namespace fenestra
