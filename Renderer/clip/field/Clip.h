#pragma once
// Clip modes. A clip multiplies the extinction by clipWeight(point), from 0 to 1. Paths evaluate it
// at points, majorant grids bound it in boxes, and camera rays skip the parts where it is 0.
//
// All modes except the plane are a depth map (ClipDepth), so that rays, SIMD code and metrics
// handle two kinds only. Surface, cutaway and hole differ in how they fill the depth map outside
// the focus; ghosts and soft edges differ in ClipEdge.

#include "base/ScalarMath.h"
#include "clip/field/DepthPyramid.h"
#include "clip/field/SilhouetteCells.h"
#include "clip/focus/DepthBuffer.h"
#include "model/camera/Camera.h"

#include <array>
#include <memory>
#include <variant>
#include <vector>

namespace fenestra::core::scalar {
#include "formulas/ClipTable.inl"
// Uses it:
#include "formulas/Clip.inl"
} // namespace fenestra::core::scalar

namespace fenestra::core {

/// Profile of the clip weight across the surface.
struct ClipEdge {
  double ghost = 0.0;    ///< weight in front of the surface; exactly representable as a float
  double softness = 0.0; ///< mm behind the surface over which the weight rises linearly to 1

  /// Weight at `distance` mm behind the surface; negative: in front.
  double operator()(double distance) const {
    return scalar::edgeWeight(ghost, perSoftness(), distance);
  }
  /// 1 / softness, 1 / mm; 0: sharp edge.
  double perSoftness() const { return softness > 0.0 ? 1.0 / softness : 0.0; }
  /// True if the weight rises at `distance`.
  bool isRamp(double distance) const { return distance >= 0.0 && distance < softness; }
  /// True if the weight is 0 in front of the surface.
  bool isHard() const { return ghost == 0.0; }

  bool operator==(const ClipEdge&) const = default;
};

struct ClipNone {
  static constexpr ClipEdge edge = {};
};

/// Removes the half-space that the normal points to.
struct ClipPlane {
  Camera camera;
  Vec3 point;  ///< world mm
  Vec3 normal; ///< world, nonzero; unit length if edge.softness > 0
  ClipEdge edge = {};

  /// Positive behind the plane, where the volume remains; mm if the normal has unit length.
  double signedDistance(const Vec3& world) const { return (point - world).dot(normal); }
};

/// Removes all points in front of the surface that a depth buffer defines.
struct ClipDepth {
  enum class Lookup { nearest, linear };

  Camera camera;
  std::shared_ptr<const DepthBuffer> buffer;   ///< -infinity where nothing is removed
  std::shared_ptr<const DepthPyramid> pyramid; ///< bounds of buffer and silhouette cells
  Lookup lookup = Lookup::linear;
  ClipEdge edge = {};
  std::shared_ptr<const SilhouetteCells> silhouette =
      nullptr; ///< null unless the boundary is exact

  /// Surface depth at (x, y), mm: points of smaller depth are removed.
  double surfaceDepth(const Vec2& position) const {
    return surfaceDepth(position, {-infinity, infinity});
  }

  /// Surface depth at `position`, mm. Outside `queryRange` it may be inexact, but is on the correct
  /// side of the range, which saves queries of the focus.
  double surfaceDepth(const Vec2& position, const Interval& queryRange) const {
    if (lookup == Lookup::nearest)
      return buffer->nearestDepth(position);
    const DepthBuffer::Cell cell = buffer->cell(position);
    const double linear = buffer->interpolate(cell);
    return silhouette ? refineAtSilhouette(cell, position, linear, queryRange) : linear;
  }

  /// Distance of a point behind the surface, mm along depth. Exact in the edge's ramp; elsewhere
  /// only the sign is guaranteed. `at`: buffer coordinates (toBuffer).
  double signedDistance(const Vec3& at) const {
    return at.z() - surfaceDepth(at.head<2>(), {at.z() - edge.softness, at.z()});
  }

private:
  double refineAtSilhouette(const DepthBuffer::Cell& cell, const Vec2& position, double linear,
                            const Interval& queryRange) const;
};

using Clip = std::variant<ClipNone, ClipPlane, ClipDepth>;

/// Fraction of the extinction that remains at a world point, 0 to 1. Behind a perspective camera it
/// is 0 for all clips except ClipNone.
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

/// Length, mm^-1, of the gradient that a soft cut adds in hybrid shading: 92 % of the scatterings
/// in an opaque cut (1 - exp(-25 gamma^3 0.8), gamma 0.5) are then at a surface. With half of the
/// gradient of the clip weight, 0.5 / softness, a cut softened over 2 mm had 54 %, and looked dull.
inline constexpr double cutSlope = 0.8;

/// Gradient, mm^-1, world axes, that a soft cut adds to the scalar gradient (in spans of the
/// transfer function) in hybrid shading. The cut is then shaded as a surface, also in a homogeneous
/// medium, whose own gradient is noise (Weiskopf, Engel, Ertl 2003):
///   cutSlope n   for 0 <= d < softness, else 0
/// where d is the signed distance behind the surface, mm, and n = grad(d) / |grad(d)| is the unit
/// normal of the cut, pointing into the remaining medium. For a plane, n is its negated normal. For
/// a depth buffer, grad(d) is that of formulas/Clip.inl, (x, y) as in toBuffer, and the depth of
/// the surface linear between samples (also in silhouette cells). With Lookup::nearest there is no
/// slope: n is the camera's forward axis. A hard edge adds nothing, since it has no depth in which
/// paths could scatter.
Vec3 cutGradient(const Clip& clip, const Vec3& world);

/// Interval of a camera ray, t >= 0, behind the clip's surface. A hard edge removes the rest.
Interval intervalBehindSurface(const Clip& clip, const Ray& cameraRay);

/// Interval of a camera ray, t >= 0, that contains all points of nonzero clip weight.
Interval visibleInterval(const Clip& clip, const Ray& cameraRay);

/// World corners of a box, in any order.
using Corners = std::array<Vec3, 8>;

/// Bounds of the clip weight over the convex hull of some corners.
struct ClipBounds {
  double max;     ///< upper bound
  bool isUniform; ///< true: the weight is `max` everywhere; false: unknown

  static const ClipBounds none, some, all;

  bool operator==(const ClipBounds&) const = default;
};
inline constexpr ClipBounds ClipBounds::none{0.0, true}, ClipBounds::some{1.0, false},
    ClipBounds::all{1.0, true};

ClipBounds boundClipWeight(const Clip& clip, const Corners& corners);

/// Depth at which the camera ray through each pixel center crosses the clip surface, mm. Infinity:
/// the ray has no unclipped part.
std::vector<float> makeClipDepth(const Camera& camera, const Clip& clip);

} // namespace fenestra::core
