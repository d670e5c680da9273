// A render depends only on the scene, the seed and the sample counts.

#include "FilmTesting.h"

namespace fenestra::core::testing::DeterminismTests {
namespace {

TEST(Determinism, ThreadsAndPassesChangeNoBit) {
  const TestScene s = makeWavyScene();
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

TEST(Determinism, DifferentSeedsGiveDifferentImages) {
  const TestScene s = makeWavyScene();
  RenderSettings settings;
  settings.samples = 4;
  const RenderResult a = s.render(settings);
  settings.seed = 1;
  EXPECT_FALSE(a.film.at(16, 10).mean == s.render(settings).film.at(16, 10).mean);
}

TEST(Render, StopOnRequestReturnsFinishedSamples) {
  const TestScene s = makeWavyScene();
  const Camera camera(s.pose, s.width, s.height);
  const LightSet lights(s.lights, s.volume.grid, camera);
  const MinMaxGrid ranges(s.volume, 0);
  const MajorantGrid majorants(s.volume.grid, ranges, s.transfer, s.clip);
  RenderMonitor monitor;
  monitor.stop = true;
  RenderSettings settings;
  const RenderResult result =
      render({s.volume, s.transfer, majorants, lights, camera, s.clip}, settings, monitor);
  EXPECT_EQ(result.reason, StopReason::request);
  EXPECT_EQ(result.finishedSamples, 0U);
}

TEST(Render, EstimatesNoiseOnlyOnRequest) {
  const TestScene s = makeWavyScene();
  RenderSettings settings;
  settings.samples = 4;
  for (const bool isWanted : {false, true}) {
    RenderMonitor monitor;
    monitor.isNoiseWanted = isWanted;
    const RenderResult result =
        s.visitView([&](const SceneView& scene) { return render(scene, settings, monitor); });
    EXPECT_EQ(monitor.noise, isWanted ? result.film.noise() : infinity);
  }
}

TEST(Render, StopsAtTimeLimitAndAtNoiseTarget) {
  const TestScene s = makeWavyScene();
  RenderSettings settings;
  settings.samples = 1u << 30;
  settings.seconds = 0.2;
  const RenderResult timed = s.render(settings);
  EXPECT_EQ(timed.reason, StopReason::seconds);
  EXPECT_GE(timed.finishedSamples, 1U);

  settings.seconds = infinity;
  settings.noise = 0.2;
  const RenderResult converged = s.render(settings);
  EXPECT_EQ(converged.reason, StopReason::noise);
  EXPECT_LE(converged.film.noise(), 0.2);
  EXPECT_GE(converged.finishedSamples, 16U);
}

TEST(Render, EndsAsAgreedAtTheEndOfAPass) {
  const TestScene s = makeWavyScene();
  const auto endAfterTwo = [&](const PassEnd& agreed) {
    RenderMonitor monitor;
    int passes = 0;
    monitor.onPassEnd = [&](const RenderResult&, PassEnd& end) {
      EXPECT_TRUE(end.isComplete);
      if (++passes == 2)
        end = agreed;
    };
    return s.visitView([&](const SceneView& scene) { return render(scene, {}, monitor); });
  };
  const RenderResult timed = endAfterTwo({true, 0, false, infinity});
  EXPECT_EQ(timed.reason, StopReason::seconds);
  EXPECT_EQ(timed.finishedSamples, 4U); // passes of 1 and 3
  const RenderResult stopped = endAfterTwo({false, 100, false, infinity});
  EXPECT_EQ(stopped.reason, StopReason::request);
  EXPECT_EQ(stopped.finishedSamples, 1U);
  EXPECT_EQ(stopped.begunSamples, 4U);
}

TEST(Render, DisplayNoiseIsEstimatedAtFixedCountsEqualInAllPixels) {
  const TestScene s = makeWavyScene();
  RenderSettings settings;
  settings.samples = 1000;
  settings.noise = 0.5;
  std::vector<std::uint64_t> counts;
  settings.isDisplayNoise = true;
  RenderMonitor monitor;
  monitor.onPassEnd = [&](const RenderResult& result, PassEnd& end) {
    if (!end.isNoiseDue)
      return;
    counts.push_back(result.film.sampleCounts().max);
    end.displayNoise = counts.size() < 3 ? 0.6 : 0.4;
  };
  for (const std::uint64_t passSamples : {0U, 3U}) {
    settings.passSamples = passSamples;
    counts.clear();
    const RenderResult result =
        s.visitView([&](const SceneView& scene) { return render(scene, settings, monitor); });
    EXPECT_EQ(result.reason, StopReason::noise);
    EXPECT_EQ(counts, (std::vector<std::uint64_t>{4, 8, 16}));
    EXPECT_EQ(result.film.sampleCounts().min, 16U);
    EXPECT_EQ(result.film.sampleCounts().max, 16U);
  }
}

} // namespace
} // namespace fenestra::core::testing::DeterminismTests
