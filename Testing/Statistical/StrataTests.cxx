// Strata: the same means as without them, less noise, and the error that pictures tell.

#include "ErrorRatio.h"
#include "RunSettings.h"

#include <gtest/gtest.h>

namespace fenestra::testing::StrataTests {
namespace {

struct Way {
  Sampling sampling;
  Integrator transport;
};
constexpr Way ways[] = {{Sampling::strata, Integrator::simd},
                        {Sampling::independent, Integrator::simd},
                        {Sampling::strata, Integrator::scalar},
                        {Sampling::independent, Integrator::scalar}};

RenderSettings settingsOf(const Way& way, std::uint64_t samples, std::uint64_t seed) {
  RenderSettings settings;
  settings.samples = samples;
  settings.sampling = way.sampling;
  settings.integrator = way.transport;
  settings.seed = seeded(seed);
  return settings;
}

/// Numbers of samples that leave blocks incomplete, too.
TEST(Strata, MeansAreThoseOfIndependentSamples) {
  const TestScene scene = fogScene();
  const int seeds = budget(80);
  for (const std::uint64_t samples : {3U, 8U, 24U}) {
    std::vector<Rgb> means;
    std::vector<Rgb> variances;
    for (const Way& way : ways) {
      Rgb sum = Rgb::Zero(), squares = Rgb::Zero();
      RenderSettings settings = settingsOf(way, samples, 1000 * (1 + means.size()));
      for (int i = 0; i < seeds; ++i, ++settings.seed) {
        Rgb mean = Rgb::Zero();
        const Film film = scene.render(settings).film;
        for (const PixelSums& pixel : film.pixels())
          mean += pixel.mean / static_cast<double>(film.pixelCount());
        sum += mean;
        squares += mean.square();
      }
      means.push_back(sum / seeds);
      variances.push_back((squares / seeds - means.back().square()) / (seeds - 1.0));
    }
    for (std::size_t a = 0; a < means.size(); ++a)
      for (std::size_t b = a + 1; b < means.size(); ++b) {
        const Rgb z = (means[a] - means[b]) / (variances[a] + variances[b]).sqrt();
        EXPECT_LT(z.abs().maxCoeff(), 4.5) << samples << " samples, ways " << a << " and " << b;
      }
  }
}

class ToldErrors : public ::testing::TestWithParam<std::uint64_t> {};

TEST_P(ToldErrors, AreThoseOverSeeds) {
  const TestScene scene = fogScene();
  const std::uint64_t samples = GetParam();
  for (const Way& way : ways) {
    const int seeds = std::max(20, budget(way.transport == Integrator::simd ? 2400 : 800) /
                                       static_cast<int>(samples + 10));
    const ErrorRatio told = errorRatio(scene, settingsOf(way, samples, 5000), seeds);
    std::printf("%d samples, %s, %s: ratio of variances %.4f +- %.4f\n", static_cast<int>(samples),
                way.sampling == Sampling::strata ? "strata" : "plain",
                way.transport == Integrator::simd ? "fast" : "readable", told.ratio, told.error);
    EXPECT_LT(told.error, 0.05);
    EXPECT_GT(told.ratio, 1.0 - 4.5 * told.error);
    const bool isEven = way.sampling == Sampling::independent || samples != 17;
    EXPECT_LT(told.ratio, (isEven ? 1.0 : 1.06) + 4.5 * told.error);
  }
}

INSTANTIATE_TEST_SUITE_P(Samples, ToldErrors, ::testing::Values(2, 8, 16, 17, 64));

TEST(Strata, TakeNoiseAway) {
  const TestScene scene = fogScene();
  for (const std::size_t fast : {0U, 2U}) {
    const int seeds = budget(240);
    const double strata = errorRatio(scene, settingsOf(ways[fast], 16, 9000), seeds).variance;
    const double plain = errorRatio(scene, settingsOf(ways[fast + 1], 16, 9000), seeds).variance;
    std::printf("variance of independent samples / of strata: %.3f\n", plain / strata);
    EXPECT_GT(plain / strata, 1.15);
  }
}

} // namespace
} // namespace fenestra::testing::StrataTests
