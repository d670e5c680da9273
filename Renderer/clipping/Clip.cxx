#include "clipping/Clip.h"

#include <algorithm>

namespace fenestra {

namespace {

/// How far, in mm, a box has to be inside the removed part: far more than rounding, far less than
/// anyone sees.
constexpr double slack = 1e-6;

Interval visiblePart(const ClipNone&, const Ray&) {
  return {};
}

Interval visiblePart(const ClipPlane& clip, const Ray& eyeRay) {
  const double above = (eyeRay.origin - clip.point).dot(clip.normal); // the removed side is > 0
  const double slope = eyeRay.direction.dot(clip.normal);
  if (slope > 0.0)
    return {0.0, std::max(0.0, -above / slope)};
  if (slope < 0.0)
    return {std::max(0.0, -above / slope), infinity};
  return above > 0.0 ? Interval{0.0, 0.0} : Interval{};
}

Interval visiblePart(const ClipDepth& clip, const Ray& eyeRay) {
  const double depthPerLength = clip.camera.depthPerLength(eyeRay);
  // Any point of the ray has its (x, y); at the target's depth rounding matters least.
  const Vec3 point = eyeRay.at(clip.camera.targetDepth() / depthPerLength);
  const double depth = clip.surface(toBuffer(clip.camera, point).head<2>());
  return {std::max(0.0, depth / depthPerLength), infinity};
}

Kept keptBox(const ClipNone&, const Corners&) {
  return Kept::all;
}

/// What of a stretch of depths, mm, lies in front of the eye.
Kept inFrontOfEye(const Camera& camera, double nearest, double farthest) {
  if (behindEye(camera, farthest + slack))
    return Kept::none;
  return behindEye(camera, nearest - slack) ? Kept::some : Kept::all;
}

Kept keptBox(const ClipPlane& clip, const Corners& corners) {
  const double margin = slack * clip.normal.norm();
  double lowest = infinity, highest = -infinity, nearest = infinity, farthest = -infinity;
  for (const Vec3& corner : corners) {
    const double height = (corner - clip.point).dot(clip.normal); // the removed side is > 0
    const double depth = clip.camera.toView(corner).z();
    lowest = std::min(lowest, height);
    highest = std::max(highest, height);
    nearest = std::min(nearest, depth);
    farthest = std::max(farthest, depth);
  }
  const Kept inFront = inFrontOfEye(clip.camera, nearest, farthest);
  if (inFront == Kept::none || lowest > margin)
    return Kept::none;
  return inFront == Kept::all && highest < -margin ? Kept::all : Kept::some;
}

Kept keptBox(const ClipDepth& clip, const Corners& corners) {
  Vec2 lower = Vec2::Constant(infinity), upper = Vec2::Constant(-infinity);
  double nearest = infinity, farthest = -infinity;
  for (const Vec3& corner : corners) {
    const Vec3 at = toBuffer(clip.camera, corner);
    lower = lower.cwiseMin(at.head<2>());
    upper = upper.cwiseMax(at.head<2>());
    nearest = std::min(nearest, at.z());
    farthest = std::max(farthest, at.z());
  }
  const Kept inFront = inFrontOfEye(clip.camera, nearest, farthest);
  if (inFront == Kept::none)
    return Kept::none;
  if (inFront == Kept::some) { // its projection has no bounds
    lower.setConstant(-infinity);
    upper.setConstant(infinity);
  }
  const DepthPyramid::Bounds surface = clip.pyramid->bounds(*clip.buffer, lower, upper);
  if (farthest + slack < surface.least)
    return Kept::none;
  return inFront == Kept::all && nearest - slack > surface.greatest ? Kept::all : Kept::some;
}

} // namespace

Interval visible(const Clip& clip, const Ray& eyeRay) {
  return std::visit([&](const auto& kind) { return visiblePart(kind, eyeRay); }, clip);
}

Kept keptIn(const Clip& clip, const Corners& corners) {
  return std::visit([&](const auto& kind) { return keptBox(kind, corners); }, clip);
}

} // namespace fenestra
