#pragma once
// Camera rays and view space, computed from the pose alone.

#include "OracleScene.h"

namespace fenestra::core::oracle {

struct View {
  Vec3 position, right, up, forward; ///< world
  double targetDepth, halfHeight;    ///< mm; halfHeight on the plane through the target
  bool isPerspective;

  explicit View(const CameraPose& pose)
      : position(pose.position),
        forward((pose.target - pose.position).normalized()),
        targetDepth((pose.target - pose.position).norm()),
        isPerspective(pose.projection == Projection::perspective) {
    up = (pose.up - pose.up.dot(forward) * forward).normalized();
    right = forward.cross(up);
    halfHeight = isPerspective ? targetDepth * std::tan(pose.angle * pi / 180.0 / 2.0) : pose.scale;
  }

  /// Camera ray through (x, y), mm, on the plane through the target; unit direction.
  Ray makeRay(double x, double y) const {
    const Vec3 onPlane = position + targetDepth * forward + x * right + y * up;
    if (isPerspective)
      return {position, (onPlane - position).normalized()};
    return {onPlane - targetDepth * forward, forward};
  }

  double depth(const Vec3& world) const { return (world - position).dot(forward); }

  /// (x, y), mm, at which the camera ray through a point meets the plane through the target.
  Vec2 toPlane(const Vec3& world) const {
    const Vec3 d = world - position;
    const double scale = isPerspective ? targetDepth / d.dot(forward) : 1.0;
    return {scale * d.dot(right), scale * d.dot(up)};
  }
};

} // namespace fenestra::core::oracle
