// A picture is a function of scene, seed and sample counts only.

#include "Support.h"

#include <gtest/gtest.h>

namespace fenestra::testing::DeterminismTests {
namespace {

TestScene scene() {
  const Grid grid = centredGrid({20, 20, 20}, {1.0, 1.0, 1.0});
  TestScene s{makeVolume<std::int16_t>(
                  grid, [](const Vec3& p) { return 100.0 * std::sin(p.x()) * std::cos(p.y()); }),
              linearTransfer(0.01, Rgb(0.9, 0.8, 0.7), 0.4),
              {EnvironmentLight{}, DirectionalLight{},
               AreaLight{.center = {0, 0, 30}, .normal = -Vec3::UnitZ(), .size = {10, 10}}},
              {},
              33,
              21};
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

void expectIdentical(const Film& a, const Film& b) {
  for (int row = 0; row < a.height(); ++row)
    for (int column = 0; column < a.width(); ++column) {
      const PixelSums& p = a.at(column, row);
      const PixelSums& q = b.at(column, row);
      ASSERT_EQ(p.samples, q.samples);
      ASSERT_TRUE(p.mean == q.mean && p.deviation == q.deviation);
      ASSERT_TRUE(p.albedo == q.albedo && p.normal == q.normal);
      ASSERT_EQ(p.depth, q.depth);
      ASSERT_EQ(p.alpha, q.alpha);
    }
}

TEST(Determinism, ThreadsAndPassesChangeNoBit) {
  const TestScene s = scene();
  RenderSettings settings;
  settings.samples = 20;
  settings.seed = 5;
  settings.threads = 1;
  settings.path.wantNormals = true;
  const RenderResult once = s.render(settings);
  EXPECT_GT(once.counters.collisions, 1000U);
  settings.threads = 2;
  expectIdentical(once.film, s.render(settings).film);
  for (const std::uint64_t passSamples : {1U, 3U, 20U}) {
    settings.passSamples = passSamples;
    expectIdentical(once.film, s.render(settings).film);
  }
}

TEST(Determinism, DifferentSeedsGiveDifferentPictures) {
  const TestScene s = scene();
  RenderSettings settings;
  settings.samples = 4;
  const RenderResult a = s.render(settings);
  settings.seed = 1;
  EXPECT_FALSE(a.film.at(16, 10).mean == s.render(settings).film.at(16, 10).mean);
}

TEST(Render, StopOnRequestReturnsFinishedSamples) {
  const TestScene s = scene();
  const Camera camera(s.pose, s.width, s.height);
  const LightSet lights(s.lights, s.volume.grid, camera);
  const CellRanges ranges(s.volume, 0);
  const MajorantGrid majorants(s.volume.grid, ranges, s.transfer, s.clip);
  RenderMonitor monitor;
  monitor.stop = true;
  RenderSettings settings;
  const RenderResult result =
      render({s.volume, s.transfer, majorants, lights, camera, s.clip}, settings, monitor);
  EXPECT_EQ(result.reason, StopReason::request);
  EXPECT_EQ(result.finishedSamples, 0U);
}

TEST(Render, StopsAtTimeLimitAndAtNoiseTarget) {
  const TestScene s = scene();
  RenderSettings settings;
  settings.samples = 1u << 30;
  settings.seconds = 0.2;
  const RenderResult timed = s.render(settings);
  EXPECT_EQ(timed.reason, StopReason::seconds);
  EXPECT_GE(timed.finishedSamples, 1U);

  settings.seconds = infinity;
  settings.noise = 0.2;
  const RenderResult quiet = s.render(settings);
  EXPECT_EQ(quiet.reason, StopReason::noise);
  EXPECT_LE(quiet.film.noise(), 0.2);
  EXPECT_GE(quiet.finishedSamples, 16U);
}

TEST(Render, StopsBySeenNoiseAtFixedCountsAlikeInAllPixels) {
  const TestScene s = scene();
  RenderSettings settings;
  settings.samples = 1000;
  settings.noise = 0.5;
  std::vector<std::uint64_t> looks;
  settings.seenNoise = [&](const Film& film) {
    looks.push_back(film.sampleCounts().greatest);
    return looks.size() < 3 ? 0.6 : 0.4;
  };
  for (const std::uint64_t passSamples : {0U, 3U}) {
    settings.passSamples = passSamples;
    looks.clear();
    const RenderResult result = s.render(settings);
    EXPECT_EQ(result.reason, StopReason::noise);
    EXPECT_EQ(looks, (std::vector<std::uint64_t>{4, 8, 16}));
    EXPECT_EQ(result.film.sampleCounts().least, 16U);
    EXPECT_EQ(result.film.sampleCounts().greatest, 16U);
  }
}

} // namespace
} // namespace fenestra::testing::DeterminismTests
