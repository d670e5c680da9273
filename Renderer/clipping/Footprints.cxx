#include "clipping/Footprints.h"

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
  Affine blockToView = cells.cellToWorld() * Eigen::Scaling(double{FocusCells::blockSize});
  Mat3 toView;
  toView << camera.right().transpose(), camera.up().transpose(), camera.forward().transpose();
  blockToView.translation() = camera.toView(blockToView.translation());
  blockToView.linear() = toView * blockToView.linear();
  // Half the extent of any block, and far more than rounding.
  const Vec3 half = 0.5001 * blockToView.linear().cwiseAbs().rowwise().sum() +
                    Vec3::Constant(1e-12 * blockToView.translation().norm());
  cells.visitOccupied([&](const Size3& block) {
    const Vec3 center = blockToView * (block.cast<double>().array() + 0.5).matrix();
    const Interval depths{center.z() - half.z(), center.z() + half.z()};
    if (depths.end < 0.0)
      return;
    Vec2 lower = Vec2::Constant(-infinity), upper = Vec2::Constant(infinity);
    if (depths.begin > 0.0 || camera.pose().projection == Projection::orthographic) {
      const double atBegin = perDepth(camera, depths.begin), atEnd = perDepth(camera, depths.end);
      lower = center.head<2>() - half.head<2>();
      upper = center.head<2>() + half.head<2>();
      lower = (lower * atBegin).cwiseMin(lower * atEnd).eval();
      upper = (upper * atBegin).cwiseMax(upper * atEnd).eval();
    }
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
