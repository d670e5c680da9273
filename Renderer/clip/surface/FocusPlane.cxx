#include "clip/surface/ClippingSurface.h"

namespace fenestra::core {

namespace {

/// Minimum-norm least-squares solution of S x = r. S = (xx, xy; xy, yy) is positive semidefinite,
/// and r is in its column space.
Vec2 solveMinimumNorm(double xx, double xy, double yy, const Vec2& r) {
  constexpr double singular = 1e-12; // ratio of eigenvalues below which samples are collinear
  const double trace = xx + yy, determinant = xx * yy - xy * xy;
  if (determinant > singular * trace * trace)
    return Vec2(yy * r.x() - xy * r.y(), xx * r.y() - xy * r.x()) / determinant;
  return trace > 0.0 ? Vec2(r / trace) : Vec2::Zero(); // S is trace d d', d a unit vector
}

} // namespace

ClipPlane fitFocusPlane(const Camera& camera, const FocusDepth& focus) {
  std::vector<Vec3> points; // visible points of the focus, in view space
  Vec3 center = Vec3::Zero();
  focus.visitFocus([&](const Vec3& at) {
    points.push_back(camera.toView(fromBuffer(camera, at)));
    center += points.back();
  });
  center /= static_cast<double>(points.size());
  double xx = 0.0, xy = 0.0, yy = 0.0;
  Vec2 rise = Vec2::Zero();
  for (const Vec3& point : points) {
    const Vec3 from = point - center;
    xx += from.x() * from.x();
    xy += from.x() * from.y();
    yy += from.y() * from.y();
    rise += from.head<2>() * from.z();
  }
  const Vec2 slope = solveMinimumNorm(xx, xy, yy, rise);
  const Vec3 toward = slope.x() * camera.right() + slope.y() * camera.up() - camera.forward();
  const Vec3 world = camera.pose().position + center.x() * camera.right() +
                     center.y() * camera.up() + center.z() * camera.forward();
  return {camera, world, toward.normalized()};
}

} // namespace fenestra::core
