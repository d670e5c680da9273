#include "clipping/FocusPlane.h"

namespace fenestra {

namespace {

/// The x with the least |S x - r|, of several the shortest; S is symmetric, its eigenvalues 0 or
/// more, and r is a sum of its columns.
Vec2 shortestSolution(const Eigen::Matrix2d& s, const Vec2& r) {
  constexpr double singular = 1e-12; // of eigenvalues to each other: samples on one line
  const double trace = s(0, 0) + s(1, 1), determinant = s(0, 0) * s(1, 1) - s(0, 1) * s(0, 1);
  if (determinant > singular * trace * trace)
    return Vec2(s(1, 1) * r.x() - s(0, 1) * r.y(), s(0, 0) * r.y() - s(0, 1) * r.x()) / determinant;
  return trace > 0.0 ? Vec2(r / trace) : Vec2::Zero().eval(); // S is trace d d'
}

} // namespace

ClipPlane focusPlane(const Camera& camera, const FocusDepth& focus) {
  std::vector<Vec3> points; // that are seen, in view space
  Vec3 center = Vec3::Zero();
  const DepthBuffer& depth = focus.depth;
  for (std::int64_t row = 0; row < depth.rows(); ++row)
    for (std::int64_t column = 0; column < depth.columns(); ++column)
      if (focus.isFocus(column, row)) {
        const Vec2 at = depth.position(column, row);
        const Vec3 world =
            fromBuffer(camera, {at.x(), at.y(), depth.at(depth.sample(column, row))});
        points.push_back(camera.toView(world));
        center += points.back();
      }
  center /= static_cast<double>(points.size());
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  Vec2 rise = Vec2::Zero();
  for (const Vec3& point : points) {
    const Vec3 from = point - center;
    spread += from.head<2>() * from.head<2>().transpose();
    rise += from.head<2>() * from.z();
  }
  const Vec2 slope = shortestSolution(spread, rise);
  const Vec3 toward = slope.x() * camera.right() + slope.y() * camera.up() - camera.forward();
  const Vec3 world = camera.pose().position + center.x() * camera.right() +
                     center.y() * camera.up() + center.z() * camera.forward();
  return {camera, world, toward.normalized()};
}

} // namespace fenestra
