#include "integrator/scalar/MajorantGrid.h"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace fenestra::core {
namespace {

/// Maximum of the transfer function over [low, high]. The interval is widened by the rounding error
/// of interpolation between two such values.
double findMaximum(const ScalarFunction& f, double low, double high) {
  const double rounding =
      4.0 * std::numeric_limits<double>::epsilon() * std::max(std::abs(low), std::abs(high));
  return f.range(low - rounding, high + rounding)[1];
}

/// Upper bound of |gradient| (scalar units per mm) if interpolated values differ by at most
/// `spread`: then each central difference is at most spread / 2 per voxel.
double boundGradient(const Grid& grid, double spread) {
  return 0.5 * spread * grid.worldToIndex.linear().transpose().columnNorms().sum();
}

float roundUp(double x) {
  const auto f = static_cast<float>(x);
  return static_cast<double>(f) < x ? std::nextafter(f, std::numeric_limits<float>::infinity()) : f;
}

/// True if the indicator can reach 1/2 in `box` (the mask's index space): one of the voxels that
/// interpolation reads there is at least threshold(). Outside the mask the border voxels repeat.
bool canReachMask(const Mask& mask, const Box& box) {
  const Vec3 last = (mask.grid.size.array() - 1).cast<double>();
  const auto clampIndex = [&](const Vec3& index) { return index.cwiseMax(0.0).cwiseMin(last); };
  const Size3 first = clampIndex(box.lower.array().floor()).cast<std::int64_t>();
  const Size3 end = clampIndex(box.upper.array().ceil()).cast<std::int64_t>().array() + 1;
  const Size3& size = mask.grid.size;
  for (std::int64_t z = first.z(); z < end.z(); ++z)
    for (std::int64_t y = first.y(); y < end.y(); ++y) {
      const auto row = mask.voxels.begin() + size.x() * (y + size.y() * z);
      if (std::any_of(row + first.x(), row + end.x(),
                      [&](std::uint8_t voxel) { return voxel >= mask.threshold(); }))
        return true;
    }
  return false;
}

/// Maximum factor by which a context style scales the extinction between the corners of a cell.
double findMaximumFactor(const ContextStyle& style, const Corners& corners) {
  Box box = Box::makeEmpty();
  for (const Vec3& corner : corners)
    box.extend(style.focus->grid.worldToIndex * corner);
  return canReachMask(*style.focus, box) ? 1.0 : style.extinction;
}

/// Cell with the majorant that remains under the clip and the style.
MajorantGrid::Cell makeCell(double clipped, double unclipped, const Corners& corners,
                            const Clip& clip, const ContextStyle* style) {
  const ClipBounds bounds =
      std::holds_alternative<ClipNone>(clip) ? ClipBounds::all : boundClipWeight(clip, corners);
  const double majorant = std::max(clipped * bounds.max, unclipped) *
                          (style ? findMaximumFactor(*style, corners) : 1.0);
  const bool isCut = majorant > 0.0 && !(bounds.isUniform && bounds.max == 1.0);
  return {roundUp(majorant), isCut};
}

/// Maximum extinction in a cell, mm^-1: of components that the clip can remove, and of unclipped
/// ones.
struct CellBound {
  double clipped = 0.0, unclipped = 0.0;
};

double findMaximum(const TransferFunction& transfer, const Grid& grid, double low, double high) {
  const double extinction = findMaximum(transfer.extinction, low, high);
  if (extinction == 0.0 || !transfer.gradientOpacity)
    return extinction;
  return extinction * findMaximum(*transfer.gradientOpacity, 0.0, boundGradient(grid, high - low));
}

/// Bound of a mixture between the corners of a cell whose scalars lie in [low, high].
CellBound boundMixture(const Mixture& mixture, const Grid& grid, const Corners& corners, double low,
                       double high) {
  // Label weights sum to 1 up to rounding.
  constexpr double rounding = 1.0 + 64.0 * std::numeric_limits<double>::epsilon();
  Box box = Box::makeEmpty();
  for (const Vec3& corner : corners)
    box.extend(mixture.weights->grid().worldToIndex * corner);
  CellBound bound;
  mixture.weights->forEachInBox(box, [&](std::uint8_t number) {
    const Component& component = mixture.components[number];
    double& maximum = component.isClipped ? bound.clipped : bound.unclipped;
    maximum = std::max(maximum, rounding * findMaximum(component.transfer, grid, low, high));
  });
  return bound;
}

/// Calls visit(index, cell) for all cells, in parallel.
template <typename Visit>
void forEachCell(const Size3& count, const Visit& visit) {
  tbb::parallel_for(std::int64_t{0}, count.z(), [&](std::int64_t z) {
    for (std::int64_t y = 0; y < count.y(); ++y)
      for (std::int64_t x = 0; x < count.x(); ++x)
        visit(static_cast<std::size_t>(x + count.x() * (y + count.y() * z)), Size3(x, y, z));
  });
}

} // namespace

ExtinctionBounds::ExtinctionBounds(const Grid& grid, const MinMaxGrid& ranges,
                                   const TransferFunction& transfer, const Mixture* mixture)
    : m_cellCount(ranges.cellCount()),
      m_edge(ranges.cellSize()),
      m_worldToCell(makeScaling(ranges.cellSize().cast<double>().cwiseInverse()) *
                    (makeTranslation(Vec3::Constant(0.5)) * grid.worldToIndex)),
      m_cellToWorld(m_worldToCell.inverse()),
      m_clipped(ranges.size()),
      m_unclipped(mixture ? ranges.size() : 0) {
  forEachCell(m_cellCount, [&](std::size_t cell, const Size3& position) {
    const double low = ranges.low(cell), high = ranges.high(cell);
    if (!mixture) {
      m_clipped[cell] = findMaximum(transfer, grid, low, high);
      return;
    }
    const CellBound bound = boundMixture(*mixture, grid, corners(position), low, high);
    m_clipped[cell] = bound.clipped;
    m_unclipped[cell] = bound.unclipped;
  });
}

Corners ExtinctionBounds::corners(const Size3& cell) const {
  const Vec3 margin = MajorantGrid::margin * m_edge.cast<double>().cwiseInverse(); // in cells
  const Vec3 lower = cell.cast<double>();
  const Box box{lower - margin, lower + margin + Vec3::Ones()};
  Corners corners;
  for (int i = 0; i < 8; ++i)
    corners[static_cast<std::size_t>(i)] = m_cellToWorld * box.corner(i);
  return corners;
}

MajorantGrid::MajorantGrid(const ExtinctionBounds& bounds, const Clip& clip,
                           const ContextStyle* style)
    : m_cellCount(bounds.cellCount()),
      m_edge(bounds.edge()),
      m_worldToCell(bounds.worldToCell()),
      m_cells(static_cast<std::size_t>(m_cellCount.prod())) {
  forEachCell(m_cellCount, [&](std::size_t cell, const Size3& position) {
    const double clipped = bounds.clipped(cell), unclipped = bounds.unclipped(cell);
    m_cells[cell] = clipped > 0.0 || unclipped > 0.0
                        ? makeCell(clipped, unclipped, bounds.corners(position), clip, style)
                        : Cell{0.0F, false};
  });
}

std::size_t MajorantGrid::emptyCount() const {
  return static_cast<std::size_t>(
      std::ranges::count_if(m_cells, [](const Cell& cell) { return cell.majorant == 0.0F; }));
}

Box MajorantGrid::occupiedBounds() const {
  Box box = Box::makeEmpty(); // in cells
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

} // namespace fenestra::core
