#pragma once
// Kinds of clip, and keep at points, on rays and in boxes. A clip multiplies the extinction by
// keep(point), from 0 to 1.

#include "clip/field/DepthPyramid.h"
#include "clip/field/SilhouetteCells.h"
#include "clip/focus/DepthBuffer.h"
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
  double operator()(double distance) const {
    if (distance < 0.0)
      return ghost;
    return distance < softness ? ghost + (1.0 - ghost) * (distance / softness) : 1.0;
  }
  /// True: keep rises at `behind`.
  bool isRamp(double distance) const { return distance >= 0.0 && distance < softness; }
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
  double signedDistance(const Vec3& world) const { return (point - world).dot(normal); }
};

/// Removes all points nearer to the eye than the surface of a depth buffer.
struct ClipDepth {
  enum class Lookup { nearest, linear };

  Camera camera;
  std::shared_ptr<const DepthBuffer> buffer;   ///< depth -infinity: nothing removed
  std::shared_ptr<const DepthPyramid> pyramid; ///< bounds of buffer and seams
  Lookup lookup = Lookup::linear;
  ClipEdge edge = {};
  std::shared_ptr<const SilhouetteCells> silhouette =
      nullptr; ///< null unless the boundary is exact

  /// Surface depth at (x, y), mm: points of smaller depth are removed.
  double surfaceDepth(const Vec2& position) const {
    return surfaceDepth(position, {-infinity, infinity});
  }

  /// Surface depth at `position`, mm. If it lies outside `between`, only the side is guaranteed,
  /// not the value.
  double surfaceDepth(const Vec2& position, const Interval& queryRange) const {
    if (lookup == Lookup::nearest)
      return buffer->nearestDepth(position);
    const DepthBuffer::Cell cell = buffer->cell(position);
    const double linear = buffer->interpolate(cell);
    return silhouette ? refineAtSilhouette(cell, position, linear, queryRange) : linear;
  }

  /// Depth of a point behind the surface, mm; negative: in front. Exact in the edge's ramp; beyond
  /// it only the side is guaranteed. `at`: as toBuffer returns it.
  double signedDistance(const Vec3& at) const {
    return at.z() - surfaceDepth(at.head<2>(), {at.z() - edge.softness, at.z()});
  }

private:
  double refineAtSilhouette(const DepthBuffer::Cell& cell, const Vec2& position, double linear,
                            const Interval& queryRange) const;
};

using Clip = std::variant<ClipNone, ClipPlane, ClipDepth>;

/// Share of the extinction that remains at a world point, 0 to 1; behind the eye 0 for every clip
/// but ClipNone.
inline double clipWeight(const ClipNone&, const Vec3&) {
  return 1.0;
}

inline double clipWeight(const ClipPlane& clip, const Vec3& world) {
  if (isBehindCamera(clip.camera, clip.camera.toView(world).z()))
    return 0.0;
  return clip.edge(clip.signedDistance(world));
}

inline double clipWeight(const ClipDepth& clip, const Vec3& world) {
  const Vec3 at = toBuffer(clip.camera, world);
  if (isBehindCamera(clip.camera, at.z()))
    return 0.0;
  return clip.edge(clip.signedDistance(at));
}

inline double clipWeight(const Clip& clip, const Vec3& world) {
  return std::visit([&](const auto& kind) { return clipWeight(kind, world); }, clip);
}

/// Weight of a soft cut among the gradients that make surfaces.
inline constexpr double cutShading = 0.5;

/// Gradient, mm^-1, world axes, that a soft cut adds to the scalar's in spans of the transfer
/// function (Weiskopf, Engel, Ertl 2003: shading on the cut):
///   cutShading / softness n   for 0 <= behind < softness, else 0
/// where `behind` is as in keep, mm, and n is the unit normal of the cut, into the matter that is
/// left: n = grad(behind) / |grad(behind)|. A plane's n is its normal, turned round. In front of a
/// depth buffer, with view axes (right, up, forward), (x, y) as in toBuffer and D the surface's
/// depth there, linear between samples (in seams too),
///   grad(behind) = (-D_x, -D_y, 1)                                         orthographic,
///   grad(behind) = (-s D_x, -s D_y, 1 + (x D_x + y D_y) / z), s = target's depth / z perspective.
/// Steps (Lookup::nearest) have no slope: n is the camera's forward axis.
Vec3 cutGradient(const Clip& clip, const Vec3& world);

/// Part of an eye ray, t >= 0, behind the clip's surface: one interval for every kind of clip. With
/// a hard edge keep = 0 on the rest of the ray.
Interval intervalBehindSurface(const Clip& clip, const Ray& cameraRay);

/// Interval of an eye ray, t >= 0, outside of which keep = 0: paths may start at its begin, and end
/// at its end.
Interval visibleInterval(const Clip& clip, const Ray& cameraRay);

/// World corners of a box, in any order.
using Corners = std::array<Vec3, 8>;

/// Bound of keep over the convex hull of some corners.
struct ClipBounds {
  double max;     ///< keep <= most
  bool isUniform; ///< true: keep = most everywhere; false: unknown

  static const ClipBounds none, some, all;

  bool operator==(const ClipBounds&) const = default;
};
inline constexpr ClipBounds ClipBounds::none{0.0, true}, ClipBounds::some{1.0, false},
    ClipBounds::all{1.0, true};

ClipBounds boundClipWeight(const Clip& clip, const Corners& corners);

} // namespace fenestra
