#pragma once
// Small volume of random voxels, with an extinction that is not monotone in the scalar, and
// images that show all of it.

#include "RgbEstimate.h"

namespace fenestra::core::testing {

/// Volume with albedo `dark` at scalar 0 and `bright` at 1, on a rotated grid of unequal spacing.
/// Its radius is about 2 mm; a third of the incident light passes.
inline TestScene makeClumps(const Rgb& dark, const Rgb& bright, double g) {
  Grid grid = makeCenteredGrid({5, 4, 6}, {0.5, 0.7, 0.4});
  const Affine rotation(makeRotation(0.5, Vec3(1.0, -2.0, 1.5).normalized()));
  grid = Grid(grid.size, rotation * grid.indexToWorld);
  Random random(91, 0, 0);
  TestScene scene{makeVolume(grid, [&](const Vec3&) { return random.uniform(); }),
                  {ScalarFunction({makeKnot(0.0, 0.0), makeKnot(0.3, 0.1), makeKnot(0.45, 6.0),
                                   makeKnot(0.5, 0.4), makeKnot(0.7, 0.3), makeKnot(0.7, 1.5),
                                   makeKnot(1.0, 0.0)}),
                   ColorFunction({{0.0, dark}, {1.0, bright}})},
                  {},
                  {},
                  8,
                  8};
  scene.transfer.g = g;
  return scene;
}

/// Radiance scattered toward -`viewDirection`, integrated over an image plane that covers the
/// complete volume, mm^2 per steradian. Parallel light travels along `light` with irradiance 1.
inline RgbEstimate estimateScattered(TestScene& scene, const Vec3& light, const Vec3& viewDirection,
                                     std::uint64_t samples, std::uint64_t seed) {
  const double radius = scene.volume.grid.boundingRadius();
  const Vec3 center = scene.volume.grid.worldCenter();
  scene.lights = {DirectionalLight{.direction = light}};
  scene.pose.target = center;
  scene.pose.position = center - 2.0 * radius * viewDirection;
  scene.pose.up = Frame(viewDirection).tangent;
  scene.pose.scale = radius;
  RenderSettings settings;
  settings.samples = samples;
  settings.seed = seed;
  return estimateRgb(scene.render(settings).film) * (4.0 * radius * radius);
}

} // namespace fenestra::core::testing
