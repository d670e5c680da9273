#pragma once
// Homogeneous slab with faces perpendicular to z, for tests of known radiance. Angles are given as
// cosines to the z axis.

#include "RgbEstimate.h"

namespace fenestra::core::testing {

/// Slab of one medium, side x side x thickness mm, seen from above: the camera looks along -z.
inline TestScene makeSlab(double side, double thickness, const Rgb& albedo, double sigma_t = 1.0) {
  const Grid grid = makeCenteredGrid({2, 2, 2}, {side / 2.0, side / 2.0, thickness / 2.0});
  TestScene scene{makeVolume(grid, [](const Vec3&) { return 1.0; }),
                  makeLinearTransfer(sigma_t, albedo),
                  {EnvironmentLight{}},
                  {},
                  8,
                  8};
  scene.pose.position = {0.0, 0.0, thickness};
  scene.pose.target = Vec3::Zero();
  scene.pose.up = Vec3::UnitY();
  scene.pose.scale = 0.01 * side;
  return scene;
}

/// Slab that is wide enough to count as infinite in double precision: the loss through the sides,
/// 10000 free paths away, decays like exp(-r / (one or two free paths)) in a slab a few free paths
/// thick.
inline TestScene makeWideSlab(double thickness, const Rgb& albedo) {
  TestScene scene = makeSlab(20000.0, thickness, albedo);
  scene.pose.scale = 1.0;
  return scene;
}

/// Unit direction downward; upward for mu < 0.
inline Vec3 downwardDirection(double mu, double azimuth = 0.0) {
  const double sine = std::sqrt(1.0 - mu * mu);
  return {sine * std::cos(azimuth), sine * std::sin(azimuth), -mu};
}

/// Makes the camera look along `direction` at the slab's center.
inline void aimCamera(TestScene& scene, const Vec3& direction) {
  scene.pose.target = Vec3::Zero();
  scene.pose.position = -1000.0 * direction; // outside the slab even at oblique angles
}

/// Mean radiance of the image, in front of a black background.
inline RgbEstimate renderMean(const TestScene& scene, std::uint64_t samples, std::uint64_t seed,
                              std::uint64_t bounces = PathSettings().bounces) {
  RenderSettings settings;
  settings.samples = scaleSamples(samples);
  settings.seed = shiftSeed(seed);
  settings.path.bounces = bounces;
  return estimateRgb(scene.render(settings).film);
}

} // namespace fenestra::core::testing
