// Adaptive sampling, planned by a pilot render, must agree with uniform sampling in the means over
// many seeds.

#include "RunSettings.h"
#include "Support.h"

#include <gtest/gtest.h>

namespace fenestra::core::testing::AdaptiveTests {
namespace {

/// Small bright light next to a dark ball: few paths hit the light by chance, so the samples of a
/// pixel are very skewed.
TestScene makeSkewedScene() {
  const Grid grid = makeCenteredGrid({12, 12, 12}, {1.0, 1.0, 1.0});
  const Vec3 center(5.5, 5.5, 5.5);
  TestScene s{
      makeVolume(grid, [&](const Vec3& p) { return (p - center).norm() < 4.0 ? 1.0 : 0.0; }),
      makeLinearTransfer(1.0, Rgb(0.95, 0.6, 0.3), 0.7),
      {EnvironmentLight{.radiance = Rgb::Constant(0.05)},
       AreaLight{.center = {0, 0, 8},
                 .normal = -Vec3::UnitZ(),
                 .size = {1, 1},
                 .radiance = Rgb::Constant(100.0)}},
      {},
      64,
      64};
  s.pose.position = {0, -30, 0};
  s.pose.target = Vec3::Zero();
  s.pose.scale = 6.0;
  return s;
}

struct Moments {
  double sum = 0.0, squares = 0.0, count = 0.0;

  void add(double x) {
    sum += x;
    squares += x * x;
    ++count;
  }
  double mean() const { return sum / count; }
  double variance() const { return (squares / count - mean() * mean()) / (count - 1.0); }
};

constexpr int tile = 16;

/// Moments over seeds of each tile's mean.
std::vector<Moments> computeTileMoments(const TestScene& scene, RenderSettings settings, int seeds,
                                        std::uint64_t firstSeed) {
  std::vector<Moments> tiles(static_cast<std::size_t>(scene.width * scene.height / (tile * tile)));
  for (int seed = 0; seed < seeds; ++seed) {
    settings.seed = shiftSeed(firstSeed + static_cast<std::uint64_t>(seed));
    const Film film = scene.render(settings).film;
    std::size_t i = 0;
    for (int top = 0; top < film.height(); top += tile)
      for (int left = 0; left < film.width(); left += tile) {
        double sum = 0.0;
        for (int pixel = 0; pixel < tile * tile; ++pixel)
          sum += film.at(left + pixel % tile, top + pixel / tile).mean.mean();
        tiles[i++].add(sum / (tile * tile));
      }
  }
  return tiles;
}

TEST(AdaptiveSampling, MeanEqualsUniformSampling) {
  const TestScene scene = makeSkewedScene();
  const int seeds = std::max(8, scaleSamples(24)); // fewer seeds would estimate the variance badly
  RenderSettings adaptive;
  adaptive.samples = 1U << 20;
  adaptive.noise = relaxError(0.05);
  RenderSettings uniform;
  uniform.samples = scaleSamples(40U);
  const std::vector<Moments> a = computeTileMoments(scene, adaptive, seeds, 0);
  const std::vector<Moments> b = computeTileMoments(scene, uniform, seeds, 100000);
  double difference = 0.0, variance = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double d = a[i].mean() - b[i].mean();
    const double v = a[i].variance() + b[i].variance();
    EXPECT_LT(std::abs(d), 4.5 * std::sqrt(v) + 1e-9) << "tile " << i;
    difference += d;
    variance += v;
  }
  EXPECT_LT(std::abs(difference), 4.0 * std::sqrt(variance));
}

TEST(AdaptiveSampling, StopsAtTargetWithUnequalSampleCounts) {
  RenderSettings settings;
  settings.samples = 1U << 20;
  settings.noise = relaxError(0.03);
  const RenderResult result = makeSkewedScene().render(settings);
  EXPECT_EQ(result.reason, StopReason::noise);
  EXPECT_LE(result.film.noise(), settings.noise);
  EXPECT_GT(result.film.noise(), 0.9 * settings.noise);
  std::uint64_t least = 1U << 20, most = 0;
  for (const PixelSums& pixel : result.film.pixels()) {
    if (pixel.isDeterministic)
      continue;
    least = std::min(least, pixel.samples);
    most = std::max(most, pixel.samples);
  }
  EXPECT_GE(least, 16U);
  EXPECT_GT(most, 2 * least);
}

} // namespace
} // namespace fenestra::core::testing::AdaptiveTests
