#include "metrics/SurfaceChange.h"

#include <algorithm>
#include <numeric>

namespace fenestra::core {
namespace {

/// Largest distance of a visible focus point from the axis, mm.
double findFocusRadius(const VisibleSurface& surface, const Vec3& axis) {
  const Camera& camera = surface.camera;
  const Vec3 direction = axis.stableNormalized();
  double radius = 0.0;
  std::size_t pixel = 0;
  for (int row = 0; row < camera.height(); ++row)
    for (int column = 0; column < camera.width(); ++column, ++pixel) {
      if (surface.regions[pixel] != Region::focus)
        continue;
      const Vec2 position = camera.toPlane(column + 0.5, row + 0.5);
      const Vec3 point = fromBuffer(camera, {position.x(), position.y(), surface.depths[pixel]});
      radius = std::max(radius, (point - camera.pose().target).cross(direction).norm());
    }
  return radius;
}

} // namespace

VisibleSurface makeVisibleSurface(const ClipDepth& clip, const std::vector<double>& focusDepth,
                                  const Domain& volume) {
  const Camera& camera = clip.camera;
  VisibleSurface surface{camera, {}, {}};
  std::size_t pixel = 0;
  for (int row = 0; row < camera.height(); ++row)
    for (int column = 0; column < camera.width(); ++column, ++pixel) {
      const Ray ray = camera.makeRay(column + 0.5, row + 0.5);
      const bool isInside = !volume.clip(transformRay(volume.grid().worldToIndex, ray)).isEmpty();
      const bool isFocus = focusDepth[pixel] < infinity;
      surface.regions.push_back(isFocus    ? Region::focus
                                : isInside ? Region::context
                                           : Region::outside);
      surface.depths.push_back(clip.buffer->at(clip.buffer->viewportSample(column, row)));
    }
  return surface;
}

SurfaceChange measureChange(const VisibleSurface& before, const VisibleSurface& after,
                            const Vec3& axis, double degrees) {
  std::vector<double> changes;
  for (std::size_t i = 0; i < before.depths.size(); ++i)
    if (before.regions[i] == Region::context && after.regions[i] == Region::context)
      changes.push_back(std::abs((after.depths[i] - before.depths[i]) / degrees));
  const double radius = std::max(findFocusRadius(before, axis), findFocusRadius(after, axis));
  SurfaceChange change{.focus = radius * pi / 180.0};
  if (changes.empty())
    return change;
  const auto count = static_cast<double>(changes.size());
  change.mean = std::accumulate(changes.begin(), changes.end(), 0.0) / count;
  change.max = std::ranges::max(changes);
  const auto p95 = changes.begin() + static_cast<std::ptrdiff_t>(0.95 * (count - 1.0));
  std::nth_element(changes.begin(), p95, changes.end());
  change.p95 = *p95;
  return change;
}

} // namespace fenestra::core
