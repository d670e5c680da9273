#include "clip/keep/Clip.h"

#include <algorithm>

namespace fenestra {

namespace {

/// Least distance, mm, of a box from the surface to count as removed or kept whole: far more than
/// rounding, far below visibility.
constexpr double slack = 1e-6;

Interval behindPart(const ClipNone&, const Ray&) {
  return {};
}

Interval behindPart(const ClipPlane& clip, const Ray& eyeRay) {
  const double above = (eyeRay.origin - clip.point).dot(clip.normal); // the removed side is > 0
  const double slope = eyeRay.direction.dot(clip.normal);
  if (slope > 0.0)
    return {0.0, std::max(0.0, -above / slope)};
  if (slope < 0.0)
    return {std::max(0.0, -above / slope), infinity};
  return above > 0.0 ? Interval{0.0, 0.0} : Interval{};
}

Interval behindPart(const ClipDepth& clip, const Ray& eyeRay) {
  const double depthPerLength = clip.camera.depthPerLength(eyeRay);
  // All points of the ray have the same (x, y); at the target's depth rounding matters least.
  const Vec3 point = eyeRay.at(clip.camera.targetDepth() / depthPerLength);
  const double depth = clip.surface(toBuffer(clip.camera, point).head<2>());
  return {std::max(0.0, depth / depthPerLength), infinity};
}

/// Position of a box relative to a part of space.
enum class Side { inside, across, outside };

/// Bound for a box at a distance of `least` to `greatest` behind the surface, mm.
Kept keptBehind(const ClipEdge& edge, double least, double greatest, Side inFrontOfEye) {
  if (inFrontOfEye == Side::outside)
    return Kept::none;
  if (inFrontOfEye == Side::inside && least > edge.softness + slack)
    return Kept::all;
  if (greatest < -slack)
    return {edge.ghost, inFrontOfEye == Side::inside || edge.isHard()};
  return Kept::some;
}

/// Position of a stretch of depths, mm, relative to the space in front of the eye.
Side inFrontOfEye(const Camera& camera, double nearest, double farthest) {
  if (behindEye(camera, farthest + slack))
    return Side::outside;
  return behindEye(camera, nearest - slack) ? Side::across : Side::inside;
}

Kept keptBox(const ClipNone&, const Corners&) {
  return Kept::all;
}

Kept keptBox(const ClipPlane& clip, const Corners& corners) {
  double least = infinity, greatest = -infinity, nearest = infinity, farthest = -infinity;
  for (const Vec3& corner : corners) {
    const double behind = clip.behind(corner);
    const double depth = clip.camera.toView(corner).z();
    least = std::min(least, behind);
    greatest = std::max(greatest, behind);
    nearest = std::min(nearest, depth);
    farthest = std::max(farthest, depth);
  }
  return keptBehind(clip.edge, least, greatest, inFrontOfEye(clip.camera, nearest, farthest));
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
  const Side side = inFrontOfEye(clip.camera, nearest, farthest);
  if (side == Side::outside)
    return Kept::none;
  if (side == Side::across) { // the box's projection is unbounded
    lower = Vec2::Constant(-infinity);
    upper = Vec2::Constant(infinity);
  }
  const DepthPyramid::Bounds surface = clip.pyramid->bounds(*clip.buffer, lower, upper);
  return keptBehind(clip.edge, nearest - surface.greatest, farthest - surface.least, side);
}

} // namespace

double ClipDepth::inSeam(const DepthBuffer::Cell& cell, const Vec2& position, double linear,
                         const Interval& between) const {
  const std::int32_t seam =
      seams->numbers()[static_cast<std::size_t>(buffer->sample(cell.column, cell.row))];
  if (seam < 0)
    return linear;
  const Seams::Reach& reach = seams->reaches()[static_cast<std::size_t>(seam)];
  const double reference = buffer->reference();
  if (between.end < std::min(linear, reference + reach.least) ||
      between.begin > std::max(linear, reference + reach.greatest))
    return linear;
  Seams::Question question{seam, position, linear - reference, between.begin - reference};
  seams->answer({&question, 1});
  return reference + question.surface;
}

Interval behindSurface(const Clip& clip, const Ray& eyeRay) {
  return std::visit([&](const auto& kind) { return behindPart(kind, eyeRay); }, clip);
}

Interval visible(const Clip& clip, const Ray& eyeRay) {
  const bool isHard = std::visit(
      [](const auto& kind) {
        if constexpr (std::is_same_v<std::decay_t<decltype(kind)>, ClipNone>)
          return true;
        else
          return kind.edge.isHard();
      },
      clip);
  return isHard ? behindSurface(clip, eyeRay) : Interval{};
}

Kept keptIn(const Clip& clip, const Corners& corners) {
  return std::visit([&](const auto& kind) { return keptBox(kind, corners); }, clip);
}

} // namespace fenestra
