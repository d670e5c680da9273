#pragma once
// Cameras of the boundary check (--position, --target, --up and --scale or --angle), computed
// independently of the renderer.

#include "base/Vector.h"

#include <cmath>
#include <string>
#include <vector>

namespace fenestra::core::accuracy {

/// View of a square image. Raster positions are in pixels; (0, 0) is the top left corner.
struct View {
  Vec3 position, target, up;
  bool isPerspective = false;
  double halfHeight = 1.0; ///< half of the visible height on the plane through the target, mm
  int size = 1;            ///< pixels per side

  /// Vertical angle of perspective, degrees.
  double angle() const { return 360.0 / pi * std::atan(halfHeight / (target - position).norm()); }

  struct CameraRay {
    Vec3 origin, direction; ///< a unit vector
    double depthPerLength;
  };
  CameraRay cameraRay(const Vec2& raster) const {
    const Vec3 forward = (target - position).normalized();
    const Vec3 right = forward.cross(up).normalized();
    const Vec3 upward = right.cross(forward);
    const Vec3 onPlane = target + halfHeight * (2.0 * raster.x() / size - 1.0) * right +
                         halfHeight * (1.0 - 2.0 * raster.y() / size) * upward;
    if (!isPerspective)
      return {onPlane - (target - position).norm() * forward, forward, 1.0};
    const Vec3 direction = (onPlane - position).normalized();
    return {position, direction, direction.dot(forward)};
  }
};

} // namespace fenestra::core::accuracy
