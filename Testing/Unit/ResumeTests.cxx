// A render resumed from a checkpoint equals an uninterrupted one, and shards add up to the complete
// image.

#include "FilmTesting.h"

namespace fenestra::core::testing::ResumeTests {
namespace {

RenderSettings makeSettings(std::uint64_t samples, double noise = -1.0) {
  RenderSettings settings;
  settings.samples = samples;
  settings.noise = noise;
  settings.path.wantNormals = true;
  return settings;
}

/// High below 32 samples, then low.
void estimateDisplayNoise(const RenderResult& result, PassEnd& end) {
  if (end.isNoiseDue)
    end.displayNoise = result.film.sampleCounts().max < 32 ? 1.0 : 0.01;
}

/// Results at every `period`-th pause of a render of `scene` that always pauses; some are in the
/// middle of a pass.
std::vector<RenderResult> collectCheckpoints(const TestScene& scene, RenderSettings settings,
                                             int period) {
  settings.threads = 2; // a pause comes after at least one tile per thread
  std::vector<RenderResult> checkpoints;
  int pauses = 0;
  RenderMonitor monitor;
  monitor.pauseAt = RenderMonitor::Clock::time_point::min();
  monitor.onPassEnd = estimateDisplayNoise;
  monitor.onPause = [&](const RenderResult& result) {
    if (++pauses % period == 0)
      checkpoints.push_back(result);
  };
  scene.visitView([&](const SceneView& s) { return render(s, settings, monitor); });
  return checkpoints;
}

RenderResult resume(const TestScene& scene, const RenderSettings& settings,
                    const std::optional<RenderResult>& checkpoint) {
  RenderMonitor monitor;
  monitor.onPassEnd = estimateDisplayNoise;
  return scene.visitView(
      [&](const SceneView& s) { return render(s, settings, monitor, checkpoint); });
}

void expectSameEnd(const RenderResult& once, const RenderResult& again) {
  expectIdentical(once.film, again.film);
  EXPECT_EQ(once.finishedSamples, again.finishedSamples);
  EXPECT_EQ(once.reason, again.reason);
}

/// True if some pixels have samples beyond the finished passes.
bool isAhead(const RenderResult& result) {
  return result.film.sampleCounts().max > result.finishedSamples;
}

TEST(Resume, EndsAtTheSameBits) {
  const TestScene scene = makeWavyScene();
  const RenderSettings settings = makeSettings(37);
  const RenderResult once = scene.render(settings);
  const auto checkpoints = collectCheckpoints(scene, settings, 5);
  ASSERT_GT(checkpoints.size(), 5U);
  EXPECT_GT(std::ranges::count_if(checkpoints, isAhead), 2);
  for (const RenderResult& checkpoint : checkpoints)
    expectSameEnd(once, resume(scene, settings, checkpoint));
  expectSameEnd(once, resume(scene, settings, once));
}

TEST(Resume, HigherLimitContinuesAfterALowerOne) {
  const TestScene scene = makeWavyScene();
  const RenderResult fewer = scene.render(makeSettings(13));
  expectSameEnd(scene.render(makeSettings(40)), resume(scene, makeSettings(40), fewer));
}

TEST(Resume, AdaptivePlanEndsAtTheSameBits) {
  const TestScene scene = makeWavyScene(80, 72);
  const RenderSettings settings = makeSettings(1000, 0.05);
  const RenderResult once = scene.render(settings);
  ASSERT_GT(once.finishedSamples, 2 * SamplePlan::pilotSamples);
  ASSERT_FALSE(once.last.plan.noise().empty());
  const auto checkpoints = collectCheckpoints(scene, settings, 41);
  ASSERT_GT(checkpoints.size(), 5U);
  for (const RenderResult& checkpoint : checkpoints)
    expectSameEnd(once, resume(scene, settings, checkpoint));
  expectSameEnd(once, resume(scene, settings, once));
}

TEST(Resume, SampleLimitDoesNotChangeThePassesOfANoiseTarget) {
  const TestScene scene = makeWavyScene(80, 72);
  const RenderResult once = scene.render(makeSettings(1000, 0.05));
  const std::pair<std::uint64_t, std::uint64_t> limitsAndPasses[] = {
      {5, 4}, {16, 16}, {19, 18}, {25, 24}}; // passes of 1, 1, 2, 4, 8; 1, 1, 2, 4, ...
  for (const auto& [samples, lastPass] : limitsAndPasses) {
    const RenderResult fewer = scene.render(makeSettings(samples, 0.05));
    EXPECT_EQ(fewer.finishedSamples, samples);
    EXPECT_EQ(fewer.last.samples, lastPass);
    expectSameEnd(once, resume(scene, makeSettings(1000, 0.05), fewer));
  }
}

/// Passes cut to one sample must not let a noise target be checked more often: the first pass after
/// the pilot ends below the target.
TEST(Resume, TimeLimitOfPassesDoesNotChangeTheImageOfANoiseTarget) {
  const TestScene scene = makeWavyScene(80, 72);
  RenderSettings settings = makeSettings(1000, 0.05);
  settings.passSamples = 1000;
  const RenderResult once = scene.render(settings);
  settings.passSeconds = 1e-9;
  expectSameEnd(once, scene.render(settings));
}

TEST(Resume, DisplayNoiseIsEstimatedAtTheSameCounts) {
  const TestScene scene = makeWavyScene();
  RenderSettings settings = makeSettings(1000, 0.05);
  settings.isDisplayNoise = true;
  const RenderResult once = resume(scene, settings, {});
  EXPECT_EQ(once.finishedSamples, 32U);
  for (const RenderResult& checkpoint : collectCheckpoints(scene, settings, 17))
    expectSameEnd(once, resume(scene, settings, checkpoint));
}

TEST(Shards, AddUpToTheCompleteImage) {
  const TestScene scene = makeWavyScene();
  RenderSettings settings = makeSettings(9);
  const RenderResult once = scene.render(settings);
  for (const int count : {1, 3, 7, 40}) { // more shards than tiles
    Film sum = once.film;
    for (int row = 0; row < sum.height(); ++row)
      for (int column = 0; column < sum.width(); ++column)
        sum.at(column, row) = {.blockSize = sum.at(column, row).blockSize}; // no samples
    for (int index = 0; index < count; ++index) {
      settings.shard = {index, count};
      const Film shard = scene.render(settings).film;
      for (int row = 0; row < sum.height(); ++row)
        for (int column = 0; column < sum.width(); ++column)
          if (shard.at(column, row).samples > 0) {
            EXPECT_EQ(sum.at(column, row).samples, 0U) << "two shards have this pixel";
            sum.at(column, row) = shard.at(column, row);
          }
    }
    expectIdentical(once.film, sum);
  }
}

TEST(Tiles, ShardsAreEquallyLargeAndScattered) {
  const Tiles tiles(500, 300);
  EXPECT_EQ(tiles.count(), 63 * 38); // of 8 x 8 pixels
  for (const int count : {1, 3, 7, 16}) {
    std::vector<int> owners(static_cast<std::size_t>(tiles.count()), 0);
    for (int index = 0; index < count; ++index) {
      const std::vector<int> shard = tiles.select({index, count});
      EXPECT_NEAR(static_cast<double>(shard.size()), 1.0 * tiles.count() / count, 1.0);
      int left = 0;
      for (const int tile : shard) {
        ++owners[static_cast<std::size_t>(tile)];
        left += tiles.at(tile).left < 250 ? 1 : 0;
      }
      EXPECT_NEAR(left, 0.5 * static_cast<double>(shard.size()), 0.06 * 63 * 38 / count);
    }
    EXPECT_EQ(std::ranges::count(owners, 1), tiles.count());
  }
  EXPECT_EQ(tiles.at(62).right, 500);
  EXPECT_EQ(tiles.at(tiles.count() - 1).bottom, 300);
}

} // namespace
} // namespace fenestra::core::testing::ResumeTests
