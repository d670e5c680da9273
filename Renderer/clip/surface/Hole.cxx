#include "clip/surface/Hole.h"

#include "clip/field/Clip.h"

namespace fenestra::core {

namespace {

/// Sets all samples outside the focus to bottom((x, y)).
template <typename Bottom>
void fillContext(DepthBuffer& buffer, const FocusDepth& focus, const Bottom& bottom) {
  for (std::int64_t row = 0; row < buffer.rows(); ++row)
    for (std::int64_t column = 0; column < buffer.columns(); ++column)
      if (!focus.isFocus(column, row))
        buffer.set(buffer.sample(column, row), bottom(buffer.position(column, row)));
}

/// Depth at which the camera ray through (x, y) leaves a sphere, mm; -infinity if it misses.
double findFarSide(const Camera& camera, const Vec2& at, const Vec3& center, double radius) {
  const Ray ray = camera.makePlaneRay(at);
  const double nearest = (center - ray.origin).dot(ray.direction);
  const double distanceSquared = (ray.at(nearest) - center).squaredNorm();
  if (distanceSquared > radius * radius)
    return -infinity;
  return (nearest + std::sqrt(radius * radius - distanceSquared)) * camera.depthPerLength(ray);
}

void fillSphere(DepthBuffer& buffer, const FocusDepth& focus, const Camera& camera, double margin) {
  Box box = Box::makeEmpty();
  focus.visitFocus([&](const Vec3& at) { box.extend(fromBuffer(camera, at)); });
  const Vec3 center = box.center();
  double radius = 0.0;
  focus.visitFocus(
      [&](const Vec3& at) { radius = std::max(radius, (fromBuffer(camera, at) - center).norm()); });
  fillContext(buffer, focus,
              [&](const Vec2& at) { return findFarSide(camera, at, center, radius + margin); });
}

} // namespace

void fillHole(DepthBuffer& buffer, const FocusDepth& focus, const Camera& camera,
              const HoleOptions& options) {
  if (options.shape == HoleShape::sphere)
    return fillSphere(buffer, focus, camera, options.margin);
  Box extent = Box::makeEmpty();
  focus.visitFocus([&](const Vec3& at) { extent.extend(at); });
  const Vec2 center = extent.center().head<2>();
  const Vec2 half = (0.5 * (extent.upper - extent.lower)).head<2>();
  double radius = 0.0;
  focus.visitFocus(
      [&](const Vec3& at) { radius = std::max(radius, (at.head<2>() - center).norm()); });
  const auto isInside = [&](const Vec2& at) {
    const Vec2 from = (at - center).cwiseAbs();
    return options.shape == HoleShape::box ? (from.array() <= half.array() + options.margin).all()
                                           : from.norm() <= radius + options.margin;
  };
  fillContext(buffer, focus,
              [&](const Vec2& at) { return isInside(at) ? extent.upper.z() : -infinity; });
}

} // namespace fenestra::core
