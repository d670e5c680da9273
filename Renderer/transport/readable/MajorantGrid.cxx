#include "transport/readable/MajorantGrid.h"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace fenestra {
namespace {

/// The transfer function's maximum over [low, high], widened by the rounding of interpolation
/// between two such values.
double greatest(const ScalarFunction& f, double low, double high) {
  const double rounding =
      4.0 * std::numeric_limits<double>::epsilon() * std::max(std::abs(low), std::abs(high));
  return f.range(low - rounding, high + rounding)[1];
}

/// Greatest |gradient| (scalar units per mm) if all interpolated values differ by at most `spread`:
/// every central difference is at most spread / 2 per voxel.
double gradientBound(const Grid& grid, double spread) {
  return 0.5 * spread * grid.worldToIndex.linear().transpose().columnNorms().sum();
}

float roundedUp(double x) {
  const auto f = static_cast<float>(x);
  return static_cast<double>(f) < x ? std::nextafter(f, std::numeric_limits<float>::infinity()) : f;
}

/// Corners of a cell with the strip around it, `margin` in cells.
Corners cornersOf(const Affine& cellToWorld, const Vec3& cell, const Vec3& margin) {
  Corners corners;
  const Box box{cell - margin, cell + margin + Vec3::Ones()};
  for (int i = 0; i < 8; ++i)
    corners[static_cast<std::size_t>(i)] = cellToWorld * box.corner(i);
  return corners;
}

/// True if the indicator may reach 1/2 in `box` (the mask's index space): a voxel around the box is
/// at least half(). Beyond the mask the outermost voxels repeat.
bool meetsMask(const Mask& mask, const Box& box) {
  const Vec3 last = (mask.grid.size.array() - 1).cast<double>();
  const auto within = [&](const Vec3& index) { return index.cwiseMax(0.0).cwiseMin(last); };
  const Size3 first = within(box.lower.array().floor()).cast<std::int64_t>();
  const Size3 end = within(box.upper.array().ceil()).cast<std::int64_t>().array() + 1;
  const Size3& size = mask.grid.size;
  for (std::int64_t z = first.z(); z < end.z(); ++z)
    for (std::int64_t y = first.y(); y < end.y(); ++y) {
      const auto row = mask.voxels.begin() + size.x() * (y + size.y() * z);
      if (std::any_of(row + first.x(), row + end.x(),
                      [&](std::uint8_t voxel) { return voxel >= mask.half(); }))
        return true;
    }
  return false;
}

/// Greatest factor of a style on the extinction among the corners of a cell.
double greatestFactor(const ContextStyle& style, const Corners& corners) {
  Box box = Box::nothing();
  for (const Vec3& corner : corners)
    box.extend(style.focus->grid.worldToIndex * corner);
  return meetsMask(*style.focus, box) ? 1.0 : style.extinction;
}

} // namespace

MajorantGrid::MajorantGrid(const Grid& grid, const CellRanges& ranges,
                           const TransferFunction& transfer, const Clip& clip,
                           const ContextStyle* style)
    : m_cellCount(ranges.cellCount()), m_edge(ranges.edge()), m_cells(ranges.size()) {
  m_worldToCell = scalingBy(ranges.edge().cast<double>().cwiseInverse()) *
                  (translationBy(Vec3::Constant(0.5)) * grid.worldToIndex);
  const Affine cellToWorld = m_worldToCell.inverse();

  const auto bound = [&](std::size_t cell) {
    const double low = ranges.low(cell);
    const double high = ranges.high(cell);
    const double extinction = greatest(transfer.extinction, low, high);
    if (extinction == 0.0 || !transfer.gradientOpacity)
      return extinction;
    return extinction * greatest(*transfer.gradientOpacity, 0.0, gradientBound(grid, high - low));
  };
  const Vec3 strip = margin * ranges.edge().cast<double>().cwiseInverse();
  tbb::parallel_for(std::int64_t{0}, m_cellCount.z(), [&](std::int64_t z) {
    for (std::int64_t y = 0; y < m_cellCount.y(); ++y)
      for (std::int64_t x = 0; x < m_cellCount.x(); ++x) {
        const auto cell = static_cast<std::size_t>(x + m_cellCount.x() * (y + m_cellCount.y() * z));
        double majorant = bound(cell);
        bool isCut = false;
        if (majorant > 0.0) {
          const Corners corners = cornersOf(cellToWorld, Size3(x, y, z).cast<double>(), strip);
          const Kept kept =
              std::holds_alternative<ClipNone>(clip) ? Kept::all : keptIn(clip, corners);
          majorant *= kept.most * (style ? greatestFactor(*style, corners) : 1.0);
          isCut = majorant > 0.0 && !(kept.isUniform && kept.most == 1.0);
        }
        m_cells[cell] = {roundedUp(majorant), isCut};
      }
  });
}

std::size_t MajorantGrid::emptyCount() const {
  return static_cast<std::size_t>(
      std::ranges::count_if(m_cells, [](const Cell& cell) { return cell.majorant == 0.0F; }));
}

Box MajorantGrid::matterBox() const {
  Box box = Box::nothing(); // in cells
  std::size_t next = 0;
  for (std::int64_t z = 0; z < m_cellCount.z(); ++z)
    for (std::int64_t y = 0; y < m_cellCount.y(); ++y)
      for (std::int64_t x = 0; x < m_cellCount.x(); ++x)
        if (m_cells[next++].majorant > 0.0F) {
          const Vec3 lower = Size3(x, y, z).cast<double>();
          box.extend(lower);
          box.extend(lower.array() + 1.0);
        }
  const Vec3 edge = m_edge.cast<double>();
  return {box.lower.cwiseProduct(edge).array() - 0.5, box.upper.cwiseProduct(edge).array() - 0.5};
}

} // namespace fenestra
