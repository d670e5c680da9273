#pragma once
// Bitwise comparison of films, and a scene with noise, scattering and empty margins.

#include "Support.h"

#include <gtest/gtest.h>

namespace fenestra::core::testing {

inline void expectIdentical(const Film& a, const Film& b) {
  ASSERT_EQ(a.width(), b.width());
  ASSERT_EQ(a.pixelCount(), b.pixelCount());
  for (std::size_t i = 0; i < a.pixelCount(); ++i) {
    const PixelSums& p = a.pixels()[i];
    const PixelSums& q = b.pixels()[i];
    ASSERT_EQ(p.samples, q.samples) << i;
    ASSERT_TRUE(p.mean == q.mean && p.m2 == q.m2) << i;
    ASSERT_TRUE(p.alpha == q.alpha && p.depth == q.depth && p.collidedSamples == q.collidedSamples)
        << i;
    ASSERT_TRUE(p.albedo == q.albedo && p.normal == q.normal) << i;
    ASSERT_TRUE(p.scatterings == q.scatterings && p.blockSize == q.blockSize) << i;
    ASSERT_TRUE(p.evenMean == q.evenMean && p.evenAlpha == q.evenAlpha) << i;
    ASSERT_TRUE(p.partialSums[0] == q.partialSums[0] && p.partialSums[1] == q.partialSums[1]) << i;
    ASSERT_TRUE(p.blockM2 == q.blockM2 && p.isDeterministic == q.isDeterministic) << i;
  }
}

/// Wavy medium lit by a sky, a sun and a lamp.
inline TestScene makeWavyScene(int width = 33, int height = 21) {
  const Grid grid = makeCenteredGrid({20, 20, 20}, {1.0, 1.0, 1.0});
  TestScene s{makeVolume<std::int16_t>(
                  grid, [](const Vec3& p) { return 100.0 * std::sin(p.x()) * std::cos(p.y()); }),
              makeLinearTransfer(0.01, Rgb(0.9, 0.8, 0.7), 0.4),
              {EnvironmentLight{}, DirectionalLight{},
               AreaLight{.center = {0, 0, 30}, .normal = -Vec3::UnitZ(), .size = {10, 10}}},
              {},
              width,
              height};
  s.transfer = {
      ScalarFunction({{-50.0, ScalarFunction::Value(0.0)}, {100.0, ScalarFunction::Value(0.8)}}),
      ColorFunction({{0.0, Rgb(0.9, 0.8, 0.7)}}),
      {},
      0.4,
      SurfaceShading{}};
  s.pose.position = {0, -60, 10};
  s.pose.target = Vec3::Zero();
  s.pose.scale = 13.0;
  return s;
}

} // namespace fenestra::core::testing
