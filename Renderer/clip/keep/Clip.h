#pragma once
// What is removed from view, and the parts of rays and boxes that are. A clip multiplies the
// extinction by keep(point), from 0 to 1.

#include "clip/focus/DepthBuffer.h"
#include "clip/keep/DepthPyramid.h"
#include "clip/keep/Seams.h"
#include "model/camera/Camera.h"

#include <array>
#include <memory>
#include <variant>

namespace fenestra {

/// (x, y) in mm where the eye ray through a world point meets the plane through the target, and the
/// point's depth. In perspective (x, y) is defined at positive depths only.
inline Vec3 toBuffer(const Camera& camera, const Vec3& world) {
  const Vec3 view = camera.toView(world);
  if (camera.pose().projection == Projection::orthographic)
    return view;
  const double scale = camera.targetDepth() / view.z();
  return {view.x() * scale, view.y() * scale, view.z()};
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

/// How keep goes from what is removed to what is not.
struct ClipEdge {
  double ghost = 0.0;    ///< keep of what is removed: 0, or a small share, a float's value
  double softness = 0.0; ///< mm behind the surface over which keep rises to 1, linearly

  /// keep at a distance behind the surface, mm.
  double operator()(double behind) const {
    if (behind < 0.0)
      return ghost;
    return behind < softness ? ghost + (1.0 - ghost) * (behind / softness) : 1.0;
  }
  /// Nothing is kept in front of the surface.
  bool isHard() const { return ghost == 0.0; }

  bool operator==(const ClipEdge&) const = default;
};

struct ClipNone {};

/// Removes the half-space that the normal points at.
struct ClipPlane {
  Camera camera;
  Vec3 point;  ///< world mm
  Vec3 normal; ///< world, not zero; unit where the edge is soft
  ClipEdge edge = {};

  /// mm behind the plane.
  double behind(const Vec3& world) const { return (point - world).dot(normal); }
};

/// Removes what is nearer to the eye than a depth buffer.
struct ClipDepth {
  enum class Lookup { nearest, linear };

  Camera camera;
  std::shared_ptr<const DepthBuffer> buffer; ///< -infinity where nothing is removed (nearest only)
  std::shared_ptr<const DepthPyramid> pyramid; ///< of the buffer, and the seams
  Lookup lookup = Lookup::linear;
  ClipEdge edge = {};
  std::shared_ptr<const Seams> seams = nullptr; ///< of an exact boundary; null elsewhere

  /// The depth at (x, y), mm, below which everything is removed.
  double surface(const Vec2& position) const { return surfaceFor(position, {-infinity, infinity}); }

  /// The same, or where it is certain that it does not lie between two depths, mm, any depth on the
  /// same side of both.
  double surfaceFor(const Vec2& position, const Interval& between) const {
    if (lookup == Lookup::nearest)
      return buffer->nearest(position);
    const DepthBuffer::Cell cell = buffer->cell(position);
    const double linear = buffer->depthIn(cell);
    return seams ? inSeam(cell, position, linear, between) : linear;
  }

private:
  double inSeam(const DepthBuffer::Cell& cell, const Vec2& position, double linear,
                const Interval& between) const;
};

using Clip = std::variant<ClipNone, ClipPlane, ClipDepth>;

/// What remains of the extinction at a world point: a share from 0 to 1.
inline double keep(const ClipNone&, const Vec3&) {
  return 1.0;
}

inline double keep(const ClipPlane& clip, const Vec3& world) {
  if (behindEye(clip.camera, clip.camera.toView(world).z()))
    return 0.0;
  return clip.edge(clip.behind(world));
}

inline double keep(const ClipDepth& clip, const Vec3& world) {
  const Vec3 at = toBuffer(clip.camera, world);
  if (behindEye(clip.camera, at.z()))
    return 0.0;
  // It may be any depth that leaves the point in front, or behind the edge.
  const Interval between{at.z() - clip.edge.softness, at.z()};
  return clip.edge(at.z() - clip.surfaceFor(at.head<2>(), between));
}

inline double keep(const Clip& clip, const Vec3& world) {
  return std::visit([&](const auto& kind) { return keep(kind, world); }, clip);
}

/// The part of an eye ray, t >= 0, that lies behind the clip's surface: one interval, for every
/// kind of clip. With a hard edge nothing else of the ray is kept.
Interval behindSurface(const Clip& clip, const Ray& eyeRay);

/// The part of an eye ray, t >= 0, outside of which keep is 0: an eye ray may start at its begin
/// and need not look beyond its end.
Interval visible(const Clip& clip, const Ray& eyeRay);

/// World corners of a box, in any order.
using Corners = std::array<Vec3, 8>;

/// What is known of keep in the convex hull of some corners.
struct Kept {
  double most;    ///< it is nowhere more
  bool isUniform; ///< it is that everywhere; may be false where it is so, too

  static const Kept none, some, all;

  bool operator==(const Kept&) const = default;
};
inline constexpr Kept Kept::none{0.0, true}, Kept::some{1.0, false}, Kept::all{1.0, true};

Kept keptIn(const Clip& clip, const Corners& corners);

} // namespace fenestra
