#pragma once
// What is removed from view, and the parts of rays and boxes that are. A clip multiplies the
// extinction by keep(point), 0 or 1.

#include "camera/Camera.h"
#include "clipping/DepthBuffer.h"
#include "clipping/DepthPyramid.h"

#include <array>
#include <memory>
#include <variant>

namespace fenestra {

/// (x, y) in mm where the eye ray through a world point meets the plane through the target, and the
/// point's depth. In perspective (x, y) is defined at positive depths only.
inline Vec3 toBuffer(const Camera& camera, const Vec3& world) {
  Vec3 view = camera.toView(world);
  if (camera.pose().projection == Projection::perspective)
    view.head<2>() *= camera.targetDepth() / view.z();
  return view;
}

/// The world point that toBuffer takes to (x, y) and this depth: the eye ray through (x, y) has it
/// there.
inline Vec3 fromBuffer(const Camera& camera, const Vec3& at) {
  const Ray ray = camera.rayThrough(at.head<2>());
  return ray.at(at.z() / camera.depthPerLength(ray));
}

/// In perspective every clip but ClipNone removes what is not in front of the eye.
inline bool behindEye(const Camera& camera, double depth) {
  return camera.pose().projection == Projection::perspective && !(depth > 0.0);
}

struct ClipNone {};

/// Removes the half-space that the normal points at.
struct ClipPlane {
  Camera camera;
  Vec3 point;  ///< world mm
  Vec3 normal; ///< world, not zero
};

/// Removes what is nearer to the eye than a depth buffer.
struct ClipDepth {
  enum class Lookup { nearest, linear };

  Camera camera;
  std::shared_ptr<const DepthBuffer> buffer; ///< -infinity where nothing is removed (nearest only)
  std::shared_ptr<const DepthPyramid> pyramid; ///< of the buffer
  Lookup lookup = Lookup::linear;

  /// The depth at (x, y), mm, below which everything is removed.
  double surface(const Vec2& position) const {
    return lookup == Lookup::linear ? buffer->depth(position) : buffer->nearest(position);
  }
};

using Clip = std::variant<ClipNone, ClipPlane, ClipDepth>;

/// What remains of the extinction at a world point: 0 or 1.
inline double keep(const ClipNone&, const Vec3&) {
  return 1.0;
}

inline double keep(const ClipPlane& clip, const Vec3& world) {
  if (behindEye(clip.camera, clip.camera.toView(world).z()))
    return 0.0;
  return (world - clip.point).dot(clip.normal) > 0.0 ? 0.0 : 1.0;
}

inline double keep(const ClipDepth& clip, const Vec3& world) {
  const Vec3 at = toBuffer(clip.camera, world);
  if (behindEye(clip.camera, at.z()))
    return 0.0;
  return at.z() < clip.surface(at.head<2>()) ? 0.0 : 1.0;
}

inline double keep(const Clip& clip, const Vec3& world) {
  return std::visit([&](const auto& kind) { return keep(kind, world); }, clip);
}

/// The part of an eye ray, t >= 0, in which keep is 1: one interval, for every kind of clip. An eye
/// ray may start at its begin and need not look beyond its end.
Interval visible(const Clip& clip, const Ray& eyeRay);

/// World corners of a box, in any order.
using Corners = std::array<Vec3, 8>;

enum class Kept { none, some, all };

/// `none` only where keep is 0 everywhere in the convex hull of the corners, `all` only where it is
/// 1 everywhere; `some` may be returned then, too.
Kept keptIn(const Clip& clip, const Corners& corners);

} // namespace fenestra
