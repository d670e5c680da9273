#include "clip/focus/Footprints.h"

#include "model/camera/BoxProjection.h"

namespace fenestra {

namespace {

/// Slack, in samples: more than rounding moves a projection.
constexpr double sampleSlack = 0.01;

/// Cells of the buffer between two positions, with slack.
CellRange cellsBetween(const DepthBuffer& buffer, const Vec2& lower, const Vec2& upper) {
  const auto [left, right] = buffer.xAxis().samplesBetween(lower.x(), upper.x(), sampleSlack);
  const auto [top, bottom] = buffer.yAxis().samplesBetween(lower.y(), upper.y(), sampleSlack);
  return {left, right, top, bottom};
}

/// Calls function(block, depths, seen) for each block of the focus's cells that is not behind the
/// eye. `depths`: of the block, mm. `seen`: cells of the buffer whose rays can pass the block.
template <typename Function>
void visitSeen(const Camera& camera, const DepthBuffer& buffer, const FocusCells& cells,
               const Function& function) {
  const BoxProjection blocks(camera, cells.cellToWorld() *
                                         scalingBy(Vec3::Constant(FocusCells::blockSize)));
  cells.visitOccupied([&](const Size3& block) {
    const auto [depths, lower, upper] = blocks.of(block);
    if (depths.end >= 0.0)
      function(block, depths, cellsBetween(buffer, lower, upper));
  });
}

/// Tiles of cells, marked if isAskedFor is set for any cell of the tile: an unmarked tile is
/// skipped at once.
class AskedTiles {
public:
  AskedTiles(const CellRange& range, const std::vector<std::uint8_t>& isAskedFor)
      : m_range(range),
        m_across(range.columns() / side + 1),
        m_isAskedFor(static_cast<std::size_t>(m_across * (range.rows() / side + 1))) {
    std::size_t cell = 0;
    for (std::int64_t row = range.top; row < range.bottom; ++row)
      for (std::int64_t column = range.left; column < range.right; ++column)
        m_isAskedFor[tile(column, row)] |= isAskedFor[cell++];
  }

  bool any(const CellRange& cells) const {
    for (std::int64_t row = cells.top; row < cells.bottom + side; row += side)
      for (std::int64_t column = cells.left; column < cells.right + side; column += side)
        if (m_isAskedFor[tile(std::min(column, cells.right), std::min(row, cells.bottom))])
          return true;
    return false;
  }

private:
  static constexpr std::int64_t side = 8;

  std::size_t tile(std::int64_t column, std::int64_t row) const {
    return static_cast<std::size_t>((column - m_range.left) / side +
                                    (row - m_range.top) / side * m_across);
  }

  CellRange m_range;
  std::int64_t m_across;
  std::vector<std::uint8_t> m_isAskedFor;
};

} // namespace

DomainFootprint::DomainFootprint(const Camera& camera, const Domain& domain) {
  for (const Vec3& corner : domain.indexCorners()) {
    const Vec3 at = toBuffer(camera, domain.grid().indexToWorld * corner);
    m_isInFront = m_isInFront && at.z() > 1e-3 * camera.targetDepth();
    m_corners.emplace_back(at.head<2>());
  }
}

DomainFootprint::Columns DomainFootprint::columns(const DepthBuffer& buffer,
                                                  std::int64_t row) const {
  if (!m_isInFront)
    return {0, buffer.columns()};
  // Part of the corners' convex hull between the rows next to this one.
  const DepthAxis& axis = buffer.yAxis();
  const auto [low, high] = std::minmax({axis.coordinate(row - 1), axis.coordinate(row + 1)});
  double first = infinity, last = -infinity;
  for (const Vec2& a : m_corners)
    for (const Vec2& b : m_corners) {
      if (a.y() > b.y() || a.y() > high || b.y() < low)
        continue;
      for (const double y : {std::max(low, a.y()), std::min(high, b.y())}) {
        const double along = b.y() > a.y() ? (y - a.y()) / (b.y() - a.y()) : 0.0;
        const double x = a.x() + along * (b.x() - a.x());
        first = std::min({first, x, b.y() > a.y() ? x : b.x()});
        last = std::max({last, x, b.y() > a.y() ? x : b.x()});
      }
    }
  if (!(first <= last))
    return {0, 0};
  const auto [begin, end] = buffer.xAxis().samplesBetween(first, last, sampleSlack);
  return {begin, end + 1};
}

FocusFootprint::FocusFootprint(const Camera& camera, const DepthBuffer& buffer,
                               const FocusCells& cells)
    : m_across((buffer.columns() + tileSize - 1) / tileSize) {
  const std::int64_t down = (buffer.rows() + tileSize - 1) / tileSize;
  m_tiles.assign(static_cast<std::size_t>(m_across * down), {infinity, -infinity});
  visitSeen(camera, buffer, cells,
            [&](const Size3&, const Interval& depths, const CellRange& seen) {
              for (std::int64_t row = seen.top / tileSize; row <= seen.bottom / tileSize; ++row)
                for (std::int64_t column = seen.left / tileSize; column <= seen.right / tileSize;
                     ++column) {
                  Interval& tile = m_tiles[static_cast<std::size_t>(column + row * m_across)];
                  tile = joined(tile, depths);
                }
            });
}

CellRange focusRange(const Camera& camera, const DepthBuffer& buffer, const FocusCells& cells) {
  CellRange range{buffer.columns(), 0, buffer.rows(), 0};
  visitSeen(camera, buffer, cells, [&](const Size3&, const Interval&, const CellRange& seen) {
    range = {std::min(range.left, seen.left), std::max(range.right, seen.right),
             std::min(range.top, seen.top), std::max(range.bottom, seen.bottom)};
  });
  return range.left < range.right && range.top < range.bottom ? range : CellRange{};
}

std::vector<Interval> focusReaches(const Camera& camera, const DepthBuffer& buffer,
                                   const FocusCells& cells, const CellRange& range,
                                   const std::vector<std::uint8_t>& isAskedFor) {
  std::vector<Interval> reaches(range.size(), {infinity, -infinity});
  const AskedTiles tiles(range, isAskedFor);
  const BoxProjection boxes(camera, cells.cellToWorld());
  const auto reach = [&](const Size3& cell) {
    const auto [depths, lower, upper] = boxes.of(cell);
    if (depths.end < 0.0)
      return;
    const CellRange seen = cellsBetween(buffer, lower, upper);
    for (std::int64_t row = seen.top; row < seen.bottom; ++row)
      for (std::int64_t column = seen.left; column < seen.right; ++column) {
        const std::size_t at = range.at(column, row);
        if (isAskedFor[at])
          reaches[at] = joined(reaches[at], depths);
      }
  };
  visitSeen(camera, buffer, cells, [&](const Size3& block, const Interval&, const CellRange& seen) {
    if (tiles.any(seen))
      cells.visitCells(block, reach);
  });
  return reaches;
}

} // namespace fenestra
