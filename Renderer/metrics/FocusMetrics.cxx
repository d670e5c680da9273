#include "metrics/FocusMetrics.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <numeric>

namespace fenestra::core {
namespace {

double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

/// Shared pointer that does not own the mask.
std::shared_ptr<const Mask> makeNonOwning(const Mask& mask) {
  return {std::shared_ptr<void>(), &mask};
}

/// Largest depth of the focus at a pixel and its neighbors.
double findDeepest(const std::vector<double>& depth, std::size_t width, std::size_t column,
                   std::size_t row) {
  double deepest = -infinity;
  for (std::size_t y = row > 0 ? row - 1 : 0; y <= row + 1 && y * width < depth.size(); ++y)
    for (std::size_t x = column > 0 ? column - 1 : 0; x <= column + 1 && x < width; ++x)
      if (const double other = depth[y * width + x]; other < infinity)
        deepest = std::max(deepest, other);
  return deepest;
}

/// Fraction of the points that the clip does not remove; 0 without points.
double computeUnclippedFraction(const FocusPoints& points) {
  if (points.empty())
    return 0.0;
  const auto count = std::ranges::count_if(points, &FocusPoint::isUnclipped);
  return static_cast<double>(count) / static_cast<double>(points.size());
}

} // namespace

FocusPoints findFocusPoints(const SceneView& scene, const std::vector<double>& depth) {
  FocusPoints points;
  const auto width = static_cast<std::size_t>(scene.camera.width());
  const double rounding = 0.5 * scene.camera.pixelPitch();
  for (std::size_t pixel = 0; pixel < depth.size(); ++pixel) {
    if (!(depth[pixel] < infinity))
      continue;
    const std::size_t row = pixel / width, column = pixel - row * width;
    const Ray ray =
        scene.camera.makeRay(static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5);
    const double distance = depth[pixel] / scene.camera.depthPerLength(ray);
    const Interval behind = intervalBehindSurface(scene.clip, ray);
    const double deepest =
        findDeepest(depth, width, column, row) / scene.camera.depthPerLength(ray);
    const bool isUnclipped = !behind.isEmpty() && behind.begin <= deepest + rounding &&
                             behind.end >= distance - rounding;
    points.push_back({ray, distance, isUnclipped, pixel});
  }
  return points;
}

double measureCoverage(const SceneView& scene, const FocusPoints& points, std::uint64_t seed,
                       const StopFlag& stop) {
  if (points.empty())
    return 0.0;
  const auto measure = [&](const auto&, const auto& tracker) {
    std::vector<double> shown(points.size(), 0.0);
    tbb::parallel_for(std::size_t{0}, points.size(), [&](std::size_t i) {
      const FocusPoint& point = points[i];
      if (!point.isUnclipped)
        return;
      const Interval range = visibleInterval(scene.clip, point.ray);
      Random random(seed, point.pixel, 0);
      Counters counters;
      shown[i] = tracker.transmittance(point.ray, {range.begin, point.distance}, random, counters);
    });
    return sum(shown) / static_cast<double>(points.size());
  };
  return withMedium(scene, measure, stop);
}

std::optional<double> measureLight(const SceneView& scene, const SceneView& focusOnly,
                                   const FocusPoints& focus, std::uint64_t seed,
                                   const StopFlag& stop) {
  constexpr std::size_t maxPoints = 4096; // unclipped points
  constexpr std::uint64_t samplesPerPoint = 4;
  std::vector<const FocusPoint*> points;
  for (const FocusPoint& point : focus)
    if (point.isUnclipped)
      points.push_back(&point);
  const std::size_t stride = points.size() / maxPoints + 1;
  const auto sumLight = [&](const SceneView& occluders) {
    const auto sumSamples = [&](const auto&, const auto& tracker) {
      std::vector<double> light(points.size() / stride + 1, 0.0);
      tbb::parallel_for(std::size_t{0}, points.size() / stride, [&](std::size_t i) {
        const FocusPoint& point = *points[i * stride];
        const Vec3 position = point.ray.at(point.distance);
        for (std::uint64_t k = 0; k < samplesPerPoint; ++k) {
          Random random(seed, point.pixel, k);
          const std::optional<LightSample> sample = scene.lights.sample(position, random);
          if (!sample)
            continue;
          Counters counters;
          light[i] += luminance(sample->radiance) / sample->pdf *
                      tracker.transmittance({position, sample->direction}, {0.0, sample->distance},
                                            random, counters);
        }
      });
      return sum(light);
    };
    return withMedium(occluders, sumSamples, stop);
  };
  const double unoccluded = sumLight(focusOnly);
  if (!(unoccluded > 0.0))
    return std::nullopt;
  return sumLight(scene) / unoccluded;
}

std::optional<double> measureContextRemoved(const SceneView& scene, const Mask& focus,
                                            std::uint64_t seed) {
  constexpr std::int64_t strata = 64; // along each axis
  const ContextStyle style{makeNonOwning(focus)};
  const ContextField field(style, scene.volume.grid);
  const Domain domain(scene.volume.grid, scene.crop);
  const Box box = scene.volume.grid.indexBox();
  return withMedium(scene, [&](const auto& medium, const auto&) {
    std::vector<double> occupied(strata), removed(strata);
    tbb::parallel_for(std::int64_t{0}, strata, [&](std::int64_t z) {
      for (std::int64_t y = 0; y < strata; ++y)
        for (std::int64_t x = 0; x < strata; ++x) {
          Random random(seed, static_cast<std::uint64_t>(x + strata * (y + strata * z)), 0);
          const Vec3 jitter(random.uniform(), random.uniform(), random.uniform());
          const Vec3 fraction = (Size3(x, y, z).cast<double>() + jitter) / double{strata};
          const Vec3 index = box.lower + fraction.cwiseProduct(box.upper - box.lower);
          const Vec3 world = scene.volume.grid.indexToWorld * index;
          if (!domain.contains(index) || field.isFocus(index) || !(medium.extinction(index) > 0.0))
            continue;
          occupied[static_cast<std::size_t>(z)] += 1.0;
          removed[static_cast<std::size_t>(z)] += 1.0 - clipWeight(scene.clip, world);
        }
    });
    const double all = sum(occupied);
    return all > 0.0 ? std::optional(sum(removed) / all) : std::nullopt;
  });
}

std::optional<FocusReport> measureFocus(const SceneView& scene, const MinMaxGrid& ranges,
                                        const Mask& focus, const std::vector<double>& depth,
                                        std::uint64_t seed, const StopFlag& stop) {
  const Clip noClip = ClipNone();
  const auto makeMajorants = [&](const ContextStyle* style) {
    return MajorantGrid(scene.volume.grid, ranges, scene.transfer, noClip, style);
  };
  const auto makeUnclipped = [&](const MajorantGrid& majorants, const ContextStyle* style) {
    return SceneView{scene.volume, scene.transfer, majorants, scene.lights, scene.camera,
                     noClip,       scene.crop,     style,     scene.tint};
  };
  const ContextStyle focusOnlyStyle{makeNonOwning(focus), 0.0, 1.0};
  const MajorantGrid allMajorants = makeMajorants(scene.style),
                     focusOnly = makeMajorants(&focusOnlyStyle);
  const SceneView unclippedScene = makeUnclipped(allMajorants, scene.style);

  const FocusPoints points = findFocusPoints(scene, depth);
  FocusReport report;
  report.unclipped = computeUnclippedFraction(points);
  report.coverage = measureCoverage(scene, points, seed, stop);
  report.withoutClip =
      measureCoverage(unclippedScene, findFocusPoints(unclippedScene, depth), seed, stop);
  report.light = measureLight(scene, makeUnclipped(focusOnly, &focusOnlyStyle), points, seed, stop);
  if (stop)
    return std::nullopt;
  report.contextRemoved = measureContextRemoved(scene, focus, seed);
  return report;
}

} // namespace fenestra::core
