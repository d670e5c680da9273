#include "clipping/Footprints.h"

#include "camera/BoxProjection.h"

namespace fenestra {

namespace {

/// Of a sample: more than rounding moves a projection.
constexpr double sampleSlack = 0.01;

/// View space to the plane through the target.
double perDepth(const Camera& camera, double depth) {
  return camera.pose().projection == Projection::perspective ? camera.targetDepth() / depth : 1.0;
}

/// The samples from the one before to the one behind coordinates a and b.
std::pair<std::int64_t, std::int64_t> samplesAround(const DepthAxis& axis, double a, double b) {
  const auto [low, high] = std::minmax({axis.index(a), axis.index(b)});
  return {static_cast<std::int64_t>(std::max(0.0, low - sampleSlack)),
          std::min(axis.size() - 1, static_cast<std::int64_t>(std::ceil(high + sampleSlack)))};
}

} // namespace

DomainFootprint::DomainFootprint(const Camera& camera, const Domain& domain) {
  for (const Vec3& corner : domain.indexCorners()) {
    const Vec3 view = camera.toView(domain.grid().indexToWorld * corner);
    m_isInFront = m_isInFront && view.z() > 1e-3 * camera.targetDepth();
    m_corners.emplace_back(view.head<2>() * perDepth(camera, view.z()));
  }
}

DomainFootprint::Columns DomainFootprint::columns(const DepthBuffer& buffer,
                                                  std::int64_t row) const {
  if (!m_isInFront)
    return {0, buffer.columns()};
  // The convex hull's part between the rows next to this one.
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
  const auto [begin, end] = samplesAround(buffer.xAxis(), first, last);
  return {begin, end + 1};
}

FocusFootprint::FocusFootprint(const Camera& camera, const DepthBuffer& buffer,
                               const FocusCells& cells)
    : m_across((buffer.columns() + tileSize - 1) / tileSize) {
  const std::int64_t down = (buffer.rows() + tileSize - 1) / tileSize;
  m_tiles.assign(static_cast<std::size_t>(m_across * down), {infinity, -infinity});
  const BoxProjection blocks(camera,
                             cells.cellToWorld() * Eigen::Scaling(double{FocusCells::blockSize}));
  cells.visitOccupied([&](const Size3& block) {
    const auto [depths, lower, upper] = blocks.of(block);
    if (depths.end < 0.0)
      return;
    const auto [left, right] = samplesAround(buffer.xAxis(), lower.x(), upper.x());
    const auto [top, bottom] = samplesAround(buffer.yAxis(), lower.y(), upper.y());
    for (std::int64_t row = top / tileSize; row <= bottom / tileSize; ++row)
      for (std::int64_t column = left / tileSize; column <= right / tileSize; ++column) {
        Interval& tile = m_tiles[static_cast<std::size_t>(column + row * m_across)];
        tile.begin = std::min(tile.begin, depths.begin);
        tile.end = std::max(tile.end, depths.end);
      }
  });
}

} // namespace fenestra
