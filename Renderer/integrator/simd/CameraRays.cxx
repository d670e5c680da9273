#include "integrator/simd/CameraRays.h"

#include "base/SimdTargets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "integrator/simd/CameraRays.cxx"
#include <hwy/foreach_target.h>
// After foreach_target.h:
#include "base/SimdSampler-inl.h"
#include "integrator/simd/Lookups-inl.h"
HWY_BEFORE_NAMESPACE();
namespace fenestra::core::HWY_NAMESPACE {
namespace {

/// Generates the paths' random numbers, and moves samples to their positions within the pixels.
void sampleAll(const CameraTable& camera, CameraSamples& samples, PathBatch& paths) {
  for (std::size_t i = 0; i < samples.size; i += laneCount) {
    const SimdPrimarySamples numbers =
        generateSamples(load(&samples.start[i]), load(&samples.key[i]), load(&samples.number[i]),
                        samples.isStratified);
    const std::size_t to = paths.rays.size + i;
    const Float row = load(&samples.row[i]);
    store(row, &paths.row[to]);
    store(row - camera.middleRow + toUniformBelow1(numbers.position[1]), &samples.row[i]);
    const Float column = load(&samples.column[i]) - camera.middleColumn;
    store(column + toUniformBelow1(numbers.position[0]), &samples.column[i]);
    store(load(&samples.tile[i]), &paths.tile[to]);
    store(load(&samples.tileSample[i]), &paths.tileSample[to]);
    store(numbers.collision[0], &paths.rays.depthBits[to]);
    store(toUniformBelow1(numbers.collision[1]), &paths.rays.acceptance[to]);
    for (const std::size_t k : {0U, 1U}) {
      store(toUniformBelow1(numbers.direction[k]), &paths.uDirection[k][to]);
      store(toUniform(numbers.choices[k]), &paths.uChoices[k][to]);
    }
    store(numbers.pathSeed[0], &paths.counter[to]);
    store(numbers.pathSeed[1], &paths.key[to]);
  }
}

void beginAll(const SimdMedium& medium, const CameraTable& camera, const CameraSamples& samples,
              PathBatch& paths) {
  for (std::size_t i = 0; i < samples.size; i += laneCount) {
    const Float x = load(&samples.column[i]), y = load(&samples.row[i]);
    const auto at = [&](const auto& middle, const auto& perColumn, const auto& perRow) {
      return Float3(middle) + x * Float3(perColumn) + y * Float3(perRow);
    };
    const Float3 toward = at(camera.forward, camera.forwardPerColumn, camera.forwardPerRow);
    const Float depthPerLength = 1.0F / sqrt(dot(toward, toward));
    const Float3 world = depthPerLength * toward;
    const Float3 direction = mapDirection(camera.toIndex, world);
    const Float3 point = at(camera.point, camera.pointPerColumn, camera.pointPerRow);
    const LaneIntervals inside = clipToDomain(
        medium, {clampZero(load(&samples.from[i])), load(&samples.to[i])}, point, direction);
    const LaneMask isInside = inside.begin < inside.end;
    const Float entry = zeroUnless(isInside, inside.begin);

    const std::size_t to = paths.rays.size + i;
    store3(point + entry * direction, paths.rays.origin, to);
    store3(direction, paths.rays.direction, to);
    store(zeroUnless(isInside, inside.end - entry), &paths.rays.length[to]);
    store3(world, paths.direction, to);
    store3(world, paths.cameraDirection, to);
    store(entry * depthPerLength, &paths.depth[to]);
    store(depthPerLength, &paths.depthPerLength[to]);
    store3({1.0F, 1.0F, 1.0F}, paths.throughput, to);
    store3({0.0F, 0.0F, 0.0F}, paths.radiance, to);
    store(Int(0), &paths.bounces[to]);
  }
}

} // namespace
} // namespace fenestra::core::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fenestra::core {

HWY_EXPORT(sampleAll);
HWY_EXPORT(beginAll);

CameraTable::CameraTable(const Domain& domain, const Camera& camera)
    : nearDepth(infinity),
      middleColumn(narrow(0.5 * camera.width())),
      middleRow(narrow(0.5 * camera.height())),
      forward(narrow3(camera.forward())) {
  const Grid& grid = domain.grid();
  for (int corner = 0; corner < 8; ++corner)
    nearDepth =
        std::min(nearDepth, camera.toView(grid.indexToWorld * domain.box().corner(corner)).z());
  nearDepth = std::max(nearDepth, 0.0);

  const bool perspective = camera.pose().projection == Projection::perspective;
  const double slope = perspective ? camera.pixelPitch() / camera.targetDepth() : 0.0;
  const double step = perspective ? slope * nearDepth : camera.pixelPitch();
  const Mat3& linear = grid.worldToIndex.linear();
  point = narrow3(grid.worldToIndex * (camera.pose().position + nearDepth * camera.forward()));
  pointPerColumn = narrow3(linear * (step * camera.right()));
  pointPerRow = narrow3(linear * (-step * camera.up()));
  forwardPerColumn = narrow3(slope * camera.right());
  forwardPerRow = narrow3(-slope * camera.up());
  toIndex = affineRows(Affine(linear));
}

void beginPaths(const SimdMedium& medium, const CameraTable& table, const CameraRays& cameraRays,
                CameraSamples& samples, PathBatch& paths) {
  HWY_DYNAMIC_DISPATCH(sampleAll)(table, samples, paths);
  if (cameraRays.isUnclipped()) {
    std::fill_n(samples.from.begin(), samples.size, 0.0F);
    std::fill_n(samples.to.begin(), samples.size, std::numeric_limits<float>::infinity());
  } else {
    for (std::size_t i = 0; i < samples.size; ++i) {
      const Ray ray = cameraRays.ray(double{table.middleColumn} + double{samples.column[i]},
                                     double{table.middleRow} + double{samples.row[i]});
      const Interval range = cameraRays.range(ray);
      const double nearDistance = table.nearDepth / cameraRays.depth(ray, 1.0);
      samples.from[i] = narrow(range.begin - nearDistance);
      samples.to[i] = narrow(range.end - nearDistance);
    }
  }
  HWY_DYNAMIC_DISPATCH(beginAll)(medium, table, samples, paths);
  paths.rays.size += samples.size;
}

} // namespace fenestra::core
#endif
