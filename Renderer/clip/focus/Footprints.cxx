#include "clip/focus/Footprints.h"

#include "model/camera/BoxProjection.h"

namespace fenestra::core {

namespace {

/// In samples; larger than the rounding error of a projection.
constexpr double sampleSlack = 0.01;

/// Cells of the buffer between two positions, with slack.
CellRange findCells(const DepthBuffer& buffer, const Vec2& lower, const Vec2& upper) {
  const auto [left, right] = buffer.xAxis().sampleRange(lower.x(), upper.x(), sampleSlack);
  const auto [top, bottom] = buffer.yAxis().sampleRange(lower.y(), upper.y(), sampleSlack);
  return {left, right, top, bottom};
}

/// Calls function(block, depths, footprint) for each block of the focus that is not behind the
/// camera, with its depths, mm, and the cells of the buffer whose rays can pass through it.
template <typename Function>
void visitVisibleBlocks(const Camera& camera, const DepthBuffer& buffer, const FocusCells& cells,
                        const Function& function) {
  const BoxProjection blocks(camera, cells.cellToWorld() *
                                         makeScaling(Vec3::Constant(FocusCells::blockSize)));
  cells.visitOccupied([&](const Size3& block) {
    const auto [depths, lower, upper] = blocks.project(block);
    if (depths.end >= 0.0)
      function(block, depths, findCells(buffer, lower, upper));
  });
}

/// Summed-area table (Crow 1984) of the requested cells: four look-ups count those in a rectangle.
class SummedAreaTable {
public:
  SummedAreaTable(const CellRange& range, const std::vector<std::uint8_t>& isRequested)
      : m_range(range),
        m_stride(range.columns() + 1),
        m_sums(static_cast<std::size_t>(m_stride * (range.rows() + 1)), 0) {
    std::size_t cell = 0;
    for (std::int64_t row = range.top; row < range.bottom; ++row) {
      std::uint32_t inRow = 0;
      for (std::int64_t column = range.left; column < range.right; ++column) {
        inRow += isRequested[cell++] != 0 ? 1U : 0U;
        m_sums[at(column + 1, row + 1)] = m_sums[at(column + 1, row)] + inRow;
      }
    }
  }

  /// True if any cell of the rectangle, which must lie in the range, is requested.
  bool hasAny(const CellRange& cells) const {
    return cells.left < cells.right && cells.top < cells.bottom &&
           m_sums[at(cells.right, cells.bottom)] + m_sums[at(cells.left, cells.top)] !=
               m_sums[at(cells.left, cells.bottom)] + m_sums[at(cells.right, cells.top)];
  }

private:
  std::size_t at(std::int64_t column, std::int64_t row) const {
    return static_cast<std::size_t>(column - m_range.left + m_stride * (row - m_range.top));
  }

  CellRange m_range;
  std::int64_t m_stride;
  std::vector<std::uint32_t> m_sums; ///< modulo 2^32
};

} // namespace

DomainFootprint::DomainFootprint(const Camera& camera, const Domain& domain) {
  for (const Vec3& corner : domain.indexCorners()) {
    const Vec3 at = toBuffer(camera, domain.grid().indexToWorld * corner);
    m_isInFront =
        m_isInFront && at.z() > 1e-3 * camera.targetDepth(); // depth 0 is projected to infinity
    m_corners.emplace_back(at.head<2>());
  }
}

DomainFootprint::Columns DomainFootprint::columns(const DepthBuffer& buffer,
                                                  std::int64_t row) const {
  if (!m_isInFront)
    return {0, buffer.columns()};
  // x range of the corners' convex hull between the previous and the next row.
  const DepthAxis& axis = buffer.yAxis();
  const auto [low, high] = std::minmax({axis.coordinate(row - 1), axis.coordinate(row + 1)});
  double first = infinity, last = -infinity;
  for (const Vec2& a : m_corners)
    for (const Vec2& b : m_corners) {
      if (a.y() > b.y() || a.y() > high || b.y() < low)
        continue;
      for (const double y : {std::max(low, a.y()), std::min(high, b.y())}) {
        const double fraction = b.y() > a.y() ? (y - a.y()) / (b.y() - a.y()) : 0.0;
        const double x = a.x() + fraction * (b.x() - a.x());
        const double otherX = b.y() > a.y() ? x : b.x(); // a horizontal edge counts with both ends
        first = std::min({first, x, otherX});
        last = std::max({last, x, otherX});
      }
    }
  if (!(first <= last))
    return {0, 0};
  const auto [begin, end] = buffer.xAxis().sampleRange(first, last, sampleSlack);
  return {begin, end + 1};
}

FocusFootprint::FocusFootprint(const Camera& camera, const DepthBuffer& buffer,
                               const FocusCells& cells)
    : m_tilesPerRow((buffer.columns() + tileSize - 1) / tileSize) {
  const std::int64_t down = (buffer.rows() + tileSize - 1) / tileSize;
  m_tiles.assign(static_cast<std::size_t>(m_tilesPerRow * down), {infinity, -infinity});
  visitVisibleBlocks(
      camera, buffer, cells, [&](const Size3&, const Interval& depths, const CellRange& footprint) {
        for (std::int64_t row = footprint.top / tileSize; row <= footprint.bottom / tileSize; ++row)
          for (std::int64_t column = footprint.left / tileSize;
               column <= footprint.right / tileSize; ++column) {
            Interval& tile = m_tiles[static_cast<std::size_t>(column + row * m_tilesPerRow)];
            tile = enclose(tile, depths);
          }
      });
}

CellRange findFocusRange(const Camera& camera, const DepthBuffer& buffer, const FocusCells& cells) {
  CellRange range{buffer.columns(), 0, buffer.rows(), 0};
  visitVisibleBlocks(
      camera, buffer, cells, [&](const Size3&, const Interval&, const CellRange& footprint) {
        range = {std::min(range.left, footprint.left), std::max(range.right, footprint.right),
                 std::min(range.top, footprint.top), std::max(range.bottom, footprint.bottom)};
      });
  return range.left < range.right && range.top < range.bottom ? range : CellRange{};
}

std::vector<Interval> computeDepthBounds(const Camera& camera, const DepthBuffer& buffer,
                                         const FocusCells& cells, const CellRange& range,
                                         const std::vector<std::uint8_t>& isRequested) {
  std::vector<Interval> bounds(range.size(), {infinity, -infinity});
  const SummedAreaTable requested(range, isRequested);
  const BoxProjection boxes(camera, cells.cellToWorld());
  const auto extendBounds = [&](const Size3& cell) {
    const auto [depths, lower, upper] = boxes.project(cell);
    if (depths.end < 0.0)
      return;
    const CellRange footprint = findCells(buffer, lower, upper);
    if (!requested.hasAny(footprint))
      return;
    for (std::int64_t row = footprint.top; row < footprint.bottom; ++row)
      for (std::int64_t column = footprint.left; column < footprint.right; ++column) {
        const std::size_t at = range.at(column, row);
        if (isRequested[at])
          bounds[at] = enclose(bounds[at], depths);
      }
  };
  visitVisibleBlocks(camera, buffer, cells,
                     [&](const Size3& block, const Interval&, const CellRange& footprint) {
                       if (requested.hasAny(footprint))
                         cells.visitCells(block, extendBounds);
                     });
  return bounds;
}

} // namespace fenestra::core
