// Tests of the tissue at the surface of a focus, on a ball with a cap of another tissue.

#include "Benchmarks/VisibleTissue.h"

#include <gtest/gtest.h>

namespace fenestra::core::benchmarks {
namespace {

constexpr double radius = 20.0, noise = 10.0; // mm, HU

struct Ball {
  Mask mask;
  Volume volume;
};

/// Ball of 60 HU with uniform noise in fat; beyond `cap`, in z, its tissue is fat, too. Voxels are
/// 1 x 1 x 2 mm.
Ball makeBall(double cap, double amplitude = noise) {
  constexpr std::int64_t width = 48, slices = 24;
  const Affine scaling = makeScaling(Vec3(1.0, 1.0, 2.0));
  Ball ball;
  ball.mask.grid = ball.volume.grid = Grid(Size3(width, width, slices), scaling);
  ball.mask.maxValue = 255;
  LargeArray<float> voxels;
  std::uint32_t state = 1;
  for (std::int64_t z = 0; z < slices; ++z)
    for (std::int64_t y = 0; y < width; ++y)
      for (std::int64_t x = 0; x < width; ++x) {
        const Vec3 at = scaling * Size3(x, y, z).cast<double>() - Vec3(23.7, 23.6, 23.3);
        const double inside = std::clamp(radius - at.norm() + 0.5, 0.0, 1.0);
        ball.mask.voxels.push_back(static_cast<std::uint8_t>(255.0 * inside + 0.5));
        state = state * 1664525U + 1013904223U;
        const double random = 2.0 * (state >> 8U) / 16777216.0 - 1.0;
        const bool isFat = at.norm() > radius + 3.0 || at.z() > cap;
        voxels.push_back(static_cast<float>(isFat ? -100.0 : 60.0 + amplitude * random));
      }
  ball.volume.voxels = std::move(voxels);
  return ball;
}

TEST(ForeignSurface, OneTissueHasNone) {
  const Ball ball = makeBall(infinity);
  EXPECT_LT(measureForeignSurface(ball.volume, ball.mask).value(), 0.001);
}

TEST(ForeignSurface, CapCountsByItsArea) {
  const Ball ball = makeBall(14.0);
  // The last slice of the organ is at 12.7 mm; the field leaves the range of its tissue 0.3 mm
  // further. 1 mm inside the surface, that is the part of a sphere of 19 mm beyond 13 mm.
  EXPECT_NEAR(measureForeignSurface(ball.volume, ball.mask).value(), 0.5 * (1.0 - 13.0 / 19.0),
              0.01);
}

TEST(ForeignSurface, NeedsOneTissueAndEnoughVoxels) {
  const Ball noisy = makeBall(infinity, 200.0);
  EXPECT_FALSE(measureForeignSurface(noisy.volume, noisy.mask));
  Ball small = makeBall(infinity);
  small.mask.voxels.assign(small.mask.voxels.size(), 0);
  EXPECT_FALSE(measureForeignSurface(small.volume, small.mask));
}

} // namespace
} // namespace fenestra::core::benchmarks
