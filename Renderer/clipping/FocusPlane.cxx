#include "clipping/FocusPlane.h"

#include <Eigen/QR>

namespace fenestra {

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
  const Vec2 slope = spread.completeOrthogonalDecomposition().solve(rise);
  const Vec3 toward = slope.x() * camera.right() + slope.y() * camera.up() - camera.forward();
  const Vec3 world = camera.pose().position + center.x() * camera.right() +
                     center.y() * camera.up() + center.z() * camera.forward();
  return {camera, world, toward.normalized()};
}

} // namespace fenestra
