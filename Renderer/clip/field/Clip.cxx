#include "clip/field/Clip.h"

#include <algorithm>

namespace fenestra::core {

namespace {

/// A box farther than this from the surface, mm, counts as entirely in front of it or behind it.
/// Far larger than rounding errors, far too small to be visible.
constexpr double slack = 1e-6;

Interval findUnclipped(const ClipNone&, const Ray&) {
  return {};
}

Interval findUnclipped(const ClipPlane& clip, const Ray& cameraRay) {
  const double height = (cameraRay.origin - clip.point).dot(clip.normal); // > 0 on the removed side
  const double slope = cameraRay.direction.dot(clip.normal);
  if (slope > 0.0)
    return {0.0, std::max(0.0, -height / slope)};
  if (slope < 0.0)
    return {std::max(0.0, -height / slope), infinity};
  return height > 0.0 ? Interval{0.0, 0.0} : Interval{};
}

Interval findUnclipped(const ClipDepth& clip, const Ray& cameraRay) {
  const double depthPerLength = clip.camera.depthPerLength(cameraRay);
  // All points of the ray have the same (x, y); rounding is smallest at the target's depth.
  const Vec3 point = cameraRay.at(clip.camera.targetDepth() / depthPerLength);
  const double depth = clip.surfaceDepth(toBuffer(clip.camera, point).head<2>());
  return {std::max(0.0, depth / depthPerLength), infinity};
}

/// cutGradient() of one kind of clip with a soft edge.
Vec3 evaluateCut(const ClipNone&, const Vec3&) {
  return Vec3::Zero();
}

Vec3 evaluateCut(const ClipPlane& clip, const Vec3& world) {
  if (isBehindCamera(clip.camera, clip.camera.toView(world).z()) ||
      !clip.edge.isRamp(clip.signedDistance(world)))
    return Vec3::Zero();
  return -cutSlope * clip.normal;
}

Vec3 evaluateCut(const ClipDepth& clip, const Vec3& world) {
  const Camera& camera = clip.camera;
  const Vec3 at = toBuffer(camera, world);
  if (isBehindCamera(camera, at.z()) || !clip.edge.isRamp(clip.signedDistance(at)))
    return Vec3::Zero();
  Vec2 slope = Vec2::Zero();
  if (clip.lookup == ClipDepth::Lookup::linear)
    slope = clip.buffer->gradient(clip.buffer->cell(at.head<2>()));
  const scalar::ViewPoints view{at.x(), at.y(), at.z(), camera.targetDepth() / at.z(), false};
  const bool perspective = camera.pose().projection == Projection::perspective;
  const scalar::Float3 gradient =
      scalar::distanceGradient(perspective, camera.targetDepth(), view, slope.x(), slope.y());
  const Mat3 fromView(camera.right(), camera.up(), camera.forward());
  return cutSlope * (fromView * toVector(gradient)).normalized();
}

/// Position of a box relative to the half-space in front of the camera.
enum class Side { inside, straddling, outside };

/// Bounds the clip weight of a box whose points have these distances behind the surface, mm.
ClipBounds boundFromDistance(const ClipEdge& edge, const Interval& distances, Side side) {
  if (side == Side::outside)
    return ClipBounds::none;
  if (side == Side::inside && distances.begin > edge.softness + slack)
    return ClipBounds::all;
  if (distances.end < -slack)
    return {edge.ghost, side == Side::inside || edge.isHard()};
  return ClipBounds::some;
}

/// Position of an interval of depths, mm, relative to the half-space in front of the camera.
Side classifyDepths(const Camera& camera, const Interval& depths) {
  if (isBehindCamera(camera, depths.end + slack))
    return Side::outside;
  return isBehindCamera(camera, depths.begin - slack) ? Side::straddling : Side::inside;
}

ClipBounds boundBox(const ClipNone&, const Corners&) {
  return ClipBounds::all;
}

ClipBounds boundBox(const ClipPlane& clip, const Corners& corners) {
  Interval distances{infinity, -infinity}, depths = distances;
  for (const Vec3& corner : corners) {
    const double distance = clip.signedDistance(corner), depth = clip.camera.toView(corner).z();
    distances = enclose(distances, {distance, distance});
    depths = enclose(depths, {depth, depth});
  }
  return boundFromDistance(clip.edge, distances, classifyDepths(clip.camera, depths));
}

ClipBounds boundBox(const ClipDepth& clip, const Corners& corners) {
  Box box = Box::makeEmpty(); // (x, y) and depths
  for (const Vec3& corner : corners)
    box.extend(toBuffer(clip.camera, corner));
  const Side side = classifyDepths(clip.camera, {box.lower.z(), box.upper.z()});
  if (side == Side::outside)
    return ClipBounds::none;
  Vec2 lower = box.lower.head<2>(), upper = box.upper.head<2>();
  if (side == Side::straddling) { // the box's projection is unbounded
    lower = Vec2::Constant(-infinity);
    upper = Vec2::Constant(infinity);
  }
  const Interval surface = clip.pyramid->bounds(*clip.buffer, lower, upper);
  return boundFromDistance(clip.edge, {box.lower.z() - surface.end, box.upper.z() - surface.begin},
                           side);
}

} // namespace

double ClipDepth::refineAtSilhouette(const DepthBuffer::Cell& cell, const Vec2& position,
                                     double linear, const Interval& queryRange) const {
  const std::int32_t silhouetteCell =
      silhouette->indices()[static_cast<std::size_t>(buffer->sample(cell.column, cell.row))];
  if (silhouetteCell < 0)
    return linear;
  const SilhouetteCells::DepthBounds& bounds =
      silhouette->depthBounds()[static_cast<std::size_t>(silhouetteCell)];
  const double reference = buffer->reference();
  if (queryRange.end < std::min(linear, reference + bounds.min) ||
      queryRange.begin > std::max(linear, reference + bounds.max))
    return linear;
  SilhouetteCells::Query query{silhouetteCell, position, linear - reference,
                               queryRange.begin - reference};
  silhouette->evaluate({&query, 1});
  return reference + query.depth;
}

Vec3 cutGradient(const Clip& clip, const Vec3& world) {
  return std::visit(
      [&](const auto& kind) -> Vec3 {
        return kind.edge.softness > 0.0 ? evaluateCut(kind, world) : Vec3::Zero();
      },
      clip);
}

Interval intervalBehindSurface(const Clip& clip, const Ray& cameraRay) {
  return std::visit([&](const auto& kind) { return findUnclipped(kind, cameraRay); }, clip);
}

Interval visibleInterval(const Clip& clip, const Ray& cameraRay) {
  const bool isHard = std::visit([](const auto& kind) { return kind.edge.isHard(); }, clip);
  return isHard ? intervalBehindSurface(clip, cameraRay) : Interval{};
}

ClipBounds boundClipWeight(const Clip& clip, const Corners& corners) {
  return std::visit([&](const auto& kind) { return boundBox(kind, corners); }, clip);
}

std::vector<float> makeClipDepth(const Camera& camera, const Clip& clip) {
  std::vector<float> result;
  for (int row = 0; row < camera.height(); ++row)
    for (int column = 0; column < camera.width(); ++column) {
      const Ray ray = camera.makeRay(column + 0.5, row + 0.5);
      const Interval range = intervalBehindSurface(clip, ray);
      const double start = range.isEmpty() ? infinity : range.begin * camera.depthPerLength(ray);
      result.push_back(static_cast<float>(start));
    }
  return result;
}

} // namespace fenestra::core
