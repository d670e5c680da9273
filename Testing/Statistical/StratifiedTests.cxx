// Stratified sampling: unbiased means, less noise, and correct estimates of the error.

#include "ErrorRatio.h"
#include "RunSettings.h"

#include <gtest/gtest.h>

namespace fenestra::core::testing::StratifiedTests {
namespace {

struct Mode {
  Sampling sampling;
  Integrator integrator;
};
constexpr Mode modes[] = {{Sampling::stratified, Integrator::simd},
                          {Sampling::independent, Integrator::simd},
                          {Sampling::stratified, Integrator::scalar},
                          {Sampling::independent, Integrator::scalar}};

RenderSettings makeSettings(const Mode& mode, std::uint64_t samples, std::uint64_t seed) {
  RenderSettings settings;
  settings.samples = samples;
  settings.sampling = mode.sampling;
  settings.integrator = mode.integrator;
  settings.seed = shiftSeed(seed);
  return settings;
}

/// Also with sample counts that leave blocks incomplete.
TEST(StratifiedSampling, MeansEqualIndependentSampling) {
  const TestScene scene = makeFogScene();
  const int seeds = scaleSamples(80);
  for (const std::uint64_t samples : {3U, 8U, 24U}) {
    std::vector<Rgb> means;
    std::vector<Rgb> variances;
    for (const Mode& mode : modes) {
      Rgb sum = Rgb::Zero(), squares = Rgb::Zero();
      RenderSettings settings = makeSettings(mode, samples, 1000 * (1 + means.size()));
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
        EXPECT_LT(z.abs().maxCoeff(), 4.5) << samples << " samples, modes " << a << " and " << b;
      }
  }
}

class EstimatedErrors : public ::testing::TestWithParam<std::uint64_t> {};

TEST_P(EstimatedErrors, EqualSpreadOverSeeds) {
  const TestScene scene = makeFogScene();
  const std::uint64_t samples = GetParam();
  for (const Mode& mode : modes) {
    const int seeds = std::max(20, scaleSamples(mode.integrator == Integrator::simd ? 2400 : 800) /
                                       static_cast<int>(samples + 10));
    const ErrorRatio measured = measureErrorRatio(scene, makeSettings(mode, samples, 5000), seeds);
    std::printf("%d samples, %s, %s: ratio of variances %.4f +- %.4f\n", static_cast<int>(samples),
                mode.sampling == Sampling::stratified ? "stratified" : "independent",
                mode.integrator == Integrator::simd ? "simd" : "scalar", measured.ratio,
                measured.error);
    EXPECT_LT(measured.error, 0.05);
    EXPECT_GT(measured.ratio, 1.0 - 4.5 * measured.error);
    // 17 samples: two complete blocks and one sample, which may bias the estimate upward.
    const bool isBiased = mode.sampling == Sampling::stratified && samples == 17;
    EXPECT_LT(measured.ratio, (isBiased ? 1.06 : 1.0) + 4.5 * measured.error);
  }
}

INSTANTIATE_TEST_SUITE_P(Samples, EstimatedErrors, ::testing::Values(2, 8, 16, 17, 64));

TEST(StratifiedSampling, ReducesNoise) {
  const TestScene scene = makeFogScene();
  for (const std::size_t first : {0U, 2U}) { // `modes`: stratified, then independent
    const int seeds = scaleSamples(240);
    const double stratified =
        measureErrorRatio(scene, makeSettings(modes[first], 16, 9000), seeds).variance;
    const double independent =
        measureErrorRatio(scene, makeSettings(modes[first + 1], 16, 9000), seeds).variance;
    std::printf("variance of independent / of stratified samples: %.3f\n",
                independent / stratified);
    EXPECT_GT(independent / stratified, 1.15);
  }
}

} // namespace
} // namespace fenestra::core::testing::StratifiedTests
