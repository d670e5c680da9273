#pragma once
// Kinds of clip, and keep at points, on rays and in boxes. A clip multiplies the extinction by
// keep(point), from 0 to 1.

#include "clip/focus/DepthBuffer.h"
#include "clip/keep/DepthPyramid.h"
#include "clip/keep/Seams.h"
#include "model/camera/Camera.h"

#include <array>
#include <memory>
#include <variant>

namespace fenestra {

/// Profile of keep across the surface.
struct ClipEdge {
  double ghost = 0.0;    ///< keep in front of the surface: 0, or a small share, a float's value
  double softness = 0.0; ///< mm behind the surface over which keep rises linearly to 1

  /// keep at `behind` mm behind the surface; negative: in front.
  double operator()(double behind) const {
    if (behind < 0.0)
      return ghost;
    return behind < softness ? ghost + (1.0 - ghost) * (behind / softness) : 1.0;
  }
  /// True: keep = 0 in front of the surface.
  bool isHard() const { return ghost == 0.0; }

  bool operator==(const ClipEdge&) const = default;
};

struct ClipNone {
  static constexpr ClipEdge edge = {};
};

/// Removes the half-space that the normal points at.
struct ClipPlane {
  Camera camera;
  Vec3 point;  ///< world mm
  Vec3 normal; ///< world, not zero; unit if edge.softness > 0
  ClipEdge edge = {};

  /// Signed distance behind the plane, mm if the normal is unit.
  double behind(const Vec3& world) const { return (point - world).dot(normal); }
};

/// Removes all points nearer to the eye than the surface of a depth buffer.
struct ClipDepth {
  enum class Lookup { nearest, linear };

  Camera camera;
  std::shared_ptr<const DepthBuffer> buffer;   ///< depth -infinity: nothing removed
  std::shared_ptr<const DepthPyramid> pyramid; ///< bounds of buffer and seams
  Lookup lookup = Lookup::linear;
  ClipEdge edge = {};
  std::shared_ptr<const Seams> seams = nullptr; ///< null unless the boundary is exact

  /// Surface depth at (x, y), mm: points of smaller depth are removed.
  double surface(const Vec2& position) const { return surfaceFor(position, {-infinity, infinity}); }

  /// Surface depth at `position`, mm. If it lies outside `between`, only the side is guaranteed,
  /// not the value.
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

/// Share of the extinction that remains at a world point, 0 to 1; behind the eye 0 for every clip
/// but ClipNone.
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
  // surface < between.begin: keep = 1; surface > between.end: keep = ghost.
  const Interval between{at.z() - clip.edge.softness, at.z()};
  return clip.edge(at.z() - clip.surfaceFor(at.head<2>(), between));
}

inline double keep(const Clip& clip, const Vec3& world) {
  return std::visit([&](const auto& kind) { return keep(kind, world); }, clip);
}

/// Part of an eye ray, t >= 0, behind the clip's surface: one interval for every kind of clip. With
/// a hard edge keep = 0 on the rest of the ray.
Interval behindSurface(const Clip& clip, const Ray& eyeRay);

/// Interval of an eye ray, t >= 0, outside of which keep = 0: paths may start at its begin, and end
/// at its end.
Interval visible(const Clip& clip, const Ray& eyeRay);

/// World corners of a box, in any order.
using Corners = std::array<Vec3, 8>;

/// Bound of keep over the convex hull of some corners.
struct Kept {
  double most;    ///< keep <= most
  bool isUniform; ///< true: keep = most everywhere; false: unknown

  static const Kept none, some, all;

  bool operator==(const Kept&) const = default;
};
inline constexpr Kept Kept::none{0.0, true}, Kept::some{1.0, false}, Kept::all{1.0, true};

Kept keptIn(const Clip& clip, const Corners& corners);

} // namespace fenestra
