#include "integrator/render/SamplePlan.h"

#include "base/Random.h"

#include <gtest/gtest.h>

namespace fenestra::core::testing::SamplePlanTests {
namespace {

constexpr std::uint64_t pilotSamples = SamplePlan::pilotSamples;

/// Film of a pilot pass, with pixels of mean 0.5 and standard deviation `sigma(column, row)`.
template <typename Sigma>
Film makePilot(int width, int height, Sigma&& sigma, double scatterings = 1.0) {
  Film film(width, height);
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column)
      for (std::uint64_t i = 0; i < pilotSamples; ++i) {
        PathSample sample;
        const double sign = i % 2 == 0 ? 1.0 : -1.0;
        sample.radiance = Rgb::Constant(0.5 + sign * sigma(column, row));
        sample.scatterings = scatterings;
        film.at(column, row).add(sample);
      }
  return film;
}

/// Standard deviation: higher in the left half.
double leftNoise(int column, int) {
  return column < 32 ? 0.4 : 0.1;
}

double computeMeanCount(const SamplePlan::Stage& stage, std::size_t pixels) {
  double sum = 0.0;
  for (std::size_t i = 0; i < pixels; ++i)
    sum += static_cast<double>(stage.count(i));
  return sum / static_cast<double>(pixels);
}

TEST(SamplePlan, AllPixelsGetEqualCountsWithoutPilot) {
  const SamplePlan plan;
  for (const std::uint64_t mean : {0U, 1U, 1000U})
    for (const std::size_t pixel : {std::size_t{0}, std::size_t{12345}})
      EXPECT_EQ(plan.at(mean).count(pixel), mean);
}

TEST(SamplePlan, CountsAreProportionalToNoise) {
  const Film pilot = makePilot(64, 64, leftNoise);
  const SamplePlan plan(pilot);
  const SamplePlan::Stage stage = plan.at(1000);
  EXPECT_NEAR(computeMeanCount(stage, pilot.pixelCount()), 1000.0, 1.0);
  const auto left = static_cast<double>(stage.count(64 * 30 + 10));
  const auto right = static_cast<double>(stage.count(64 * 30 + 50));
  EXPECT_NEAR(left / right, 4.0, 0.02);
  EXPECT_NEAR(stage.maxRatio(), left / 1000.0, 0.01);
}

TEST(SamplePlan, ExpensivePathsGetFewerSamples) {
  Film pilot = makePilot(64, 64, [](int, int) { return 0.3; });
  for (int row = 0; row < 64; ++row)
    for (int column = 0; column < 32; ++column)
      pilot.at(column, row).scatterings *= 4.0;
  const SamplePlan plan(pilot);
  const SamplePlan::Stage stage = plan.at(1000);
  EXPECT_LT(stage.count(64 * 30 + 10), stage.count(64 * 30 + 50));
}

TEST(SamplePlan, EveryPixelGetsThePilotAndCountsNeverDecrease) {
  const Film pilot = makePilot(64, 64, leftNoise);
  const SamplePlan plan(pilot);
  for (const std::uint64_t mean : {1U, 7U, 16U})
    EXPECT_EQ(plan.at(mean).count(0), mean) << "a stage within the pilot";
  for (std::size_t pixel = 0; pixel < pilot.pixelCount(); pixel += 97) {
    std::uint64_t before = 0;
    for (std::uint64_t mean = 0; mean < 200; mean += 3) {
      const std::uint64_t count = plan.at(mean).count(pixel);
      EXPECT_GE(count, before);
      EXPECT_GE(count, std::min(mean, pilotSamples));
      before = count;
    }
  }
}

/// A pixel's samples may affect its own count only through the noise of all pixels; otherwise the
/// estimate is biased.
TEST(SamplePlan, CountBarelyDependsOnThePixelsOwnSamples) {
  const SamplePlan plain(makePilot(64, 64, leftNoise));
  const SamplePlan other(makePilot(64, 64, [](int column, int row) {
    return column == 10 && row == 30 ? 4.0 : leftNoise(column, row);
  }));
  const std::size_t pixel = 64 * 30 + 10;
  const auto expected = static_cast<double>(plain.at(1000).count(pixel));
  EXPECT_NEAR(static_cast<double>(other.at(1000).count(pixel)), expected, 0.03 * expected);
  EXPECT_GT(static_cast<double>(other.at(1000).count(pixel + 1)), 1.2 * expected) << "the neighbor";
}

TEST(SamplePlan, NoiselessAndTinyImagesAreSampledUniformly) {
  const SamplePlan noiseless(makePilot(64, 64, [](int, int) { return 0.0; }));
  EXPECT_EQ(noiseless.at(100).count(5), 100U);
  EXPECT_EQ(noiseless.at(100).maxRatio(), 1.0);
  for (const int size : {1, 2, 32}) {
    const SamplePlan tiny(makePilot(size, size, [](int column, int) { return 0.1 + column; }));
    EXPECT_EQ(tiny.at(100).count(0), 100U);
  }
}

} // namespace
} // namespace fenestra::core::testing::SamplePlanTests
