// A million samples per pixel: sums neither drift nor wrap.

#include "StressSupport.h"

namespace fenestra::core::testing::AccumulationStressTests {
namespace {

constexpr std::uint64_t million = 1'000'000;

/// 2x2 pixels of a small scattering volume, brighter on one side.
TestScene makeSmallScene() {
  TestScene scene{makeVolume(makeCenteredGrid({3, 3, 3}, Vec3::Ones()),
                             [](const Vec3& p) { return 0.4 + 0.1 * p.x(); }),
                  makeLinearTransfer(0.4, Rgb(0.9, 0.5, 0.1)),
                  {EnvironmentLight{}},
                  {},
                  2,
                  2};
  DirectionalLight sun;
  sun.irradiance = Rgb(1e3, 1.0, 1e-3);
  scene.lights.emplace_back(sun);
  scene.pose.position = {3.0, -9.0, 2.0};
  scene.pose.target = Vec3::Zero();
  scene.pose.scale = 2.0;
  return scene;
}

/// Samples first ... first + count - 1 of a pixel, generated as in a render.
std::vector<PathSample> traceSamples(const TestScene& scene, int column, int row,
                                     std::uint64_t first, std::uint64_t count) {
  std::vector<PathSample> samples;
  samples.reserve(count);
  withIntegrator(scene, [&](const auto& estimator) {
    Counters counters;
    const Sampler source(RenderSettings().sampling, 7);
    const auto pixel = static_cast<std::uint64_t>(row * scene.width + column);
    for (std::uint64_t i = first; i < first + count; ++i) {
      const PrimarySamples numbers = source.generate(pixel, i);
      const Vec2 jitter = toUniform2(numbers.position);
      samples.push_back(*estimator.trace(column + jitter.x(), row + jitter.y(), numbers, counters));
    }
  });
  return samples;
}

struct Moments {
  long double mean = 0.0L, m2 = 0.0L; ///< red channel, in two passes
};

Moments computeTwoPass(const std::vector<PathSample>& samples) {
  Moments moments;
  for (const PathSample& sample : samples)
    moments.mean += static_cast<long double>(sample.radiance[0]);
  moments.mean /= static_cast<long double>(samples.size());
  for (const PathSample& sample : samples) {
    const long double d = static_cast<long double>(sample.radiance[0]) - moments.mean;
    moments.m2 += d * d;
  }
  return moments;
}

TEST(Accumulation, MillionSamplesEqualTwoPasses) {
  const TestScene scene = makeSmallScene();
  const std::vector<PathSample> samples = traceSamples(scene, 0, 1, 0, million);
  PixelSums sums;
  for (const PathSample& sample : samples)
    sums.add(sample);
  const Moments exact = computeTwoPass(samples);
  EXPECT_EQ(sums.samples, million);
  EXPECT_NEAR(sums.mean[0] / static_cast<double>(exact.mean), 1.0, 1e-12);
  EXPECT_NEAR(sums.m2[0] / static_cast<double>(exact.m2), 1.0, 1e-12);

  // A large offset must not reduce the variance's precision beyond the offset's own roundoff.
  PixelSums shifted;
  std::vector<PathSample> far = samples;
  for (PathSample& sample : far) {
    sample.radiance += 1e6;
    shifted.add(sample);
  }
  const Moments exactFar = computeTwoPass(far);
  EXPECT_NEAR(shifted.mean[0] / static_cast<double>(exactFar.mean), 1.0, 1e-12);
  EXPECT_NEAR(shifted.m2[0] / static_cast<double>(exactFar.m2), 1.0, 1e-9);
}

TEST(Accumulation, MillionSamplesEqualRenderAndDoNotDrift) {
  const TestScene scene = makeSmallScene();
  RenderSettings settings;
  settings.samples = million;
  settings.seed = 7;
  const Film simdFilm = scene.render(settings).film;
  settings.integrator = Integrator::scalar;
  const Film film = scene.render(settings).film;
  for (int row = 0; row < 2; ++row)
    for (int column = 0; column < 2; ++column) {
      PixelSums first, second, all;
      for (const std::uint64_t begin : {std::uint64_t{0}, million / 2})
        for (const PathSample& sample : traceSamples(scene, column, row, begin, million / 2)) {
          (begin == 0 ? first : second).add(sample);
          all.add(sample);
        }
      EXPECT_TRUE(film.at(column, row).mean == all.mean);
      EXPECT_TRUE(film.at(column, row).m2 == all.m2);
      const Rgb difference = (first.mean - second.mean).abs();
      const Rgb error = (first.standardError().square() + second.standardError().square()).sqrt();
      EXPECT_TRUE((difference < 4.0 * error).all()) << difference << ", errors " << error;
      const Rgb other = (simdFilm.at(column, row).mean - all.mean).abs();
      EXPECT_TRUE((other < 4.0 * std::sqrt(2.0) * all.standardError()).all())
          << other << ", error of each " << all.standardError();
    }
}

TEST(SampleCounters, DoNotWrapBeyond32Bits) {
  constexpr std::uint64_t before = (std::uint64_t{1} << 32) - 1;
  PixelSums sums;
  sums.samples = before; // state after this number of samples of radiance 1
  sums.collidedSamples = before;
  sums.mean = Rgb::Ones();
  sums.alpha = static_cast<double>(before);
  PathSample sample;
  sample.radiance = Rgb::Constant(2.0);
  sample.depth = 5.0;
  for (int i = 0; i < 2; ++i)
    sums.add(sample);
  EXPECT_EQ(sums.samples, before + 2);
  EXPECT_EQ(sums.collidedSamples, before + 2);
  EXPECT_EQ(sums.alpha, static_cast<double>(before) + 2.0);
  const double n = static_cast<double>(before) + 2.0;
  EXPECT_NEAR((sums.mean[0] - 1.0) * n, 2.0, 1e-5); // roundoff of a mean near 1, times n
  EXPECT_NEAR(sums.m2[0], 2.0 * (n - 2.0) / n, 1e-9);
  EXPECT_NEAR(sums.standardError()[0] * n, std::sqrt(2.0), 1e-8);
}

TEST(SampleIndices, IndicesBeyond32BitsGiveNewSamples) {
  const TestScene scene = makeSmallScene();
  constexpr std::uint64_t count = 20000;
  constexpr std::uint64_t far = (std::uint64_t{1} << 32) * 3;
  PixelSums near, beyond;
  double covariance = 0.0; // times count
  const auto a = traceSamples(scene, 0, 0, 0, count);
  const auto b = traceSamples(scene, 0, 0, far, count);
  for (std::size_t i = 0; i < count; ++i) {
    near.add(a[i]);
    beyond.add(b[i]);
  }
  for (std::size_t i = 0; i < count; ++i) {
    covariance += (a[i].radiance[1] - near.mean[1]) * (b[i].radiance[1] - beyond.mean[1]);
  }
  const double normalization = std::sqrt(near.m2[1] * beyond.m2[1]);
  EXPECT_LT(std::abs(covariance / normalization), 4.0 / std::sqrt(static_cast<double>(count)));
  const double error = std::hypot(near.standardError()[1], beyond.standardError()[1]);
  EXPECT_NEAR(near.mean[1], beyond.mean[1], 4.0 * error);
}

} // namespace
} // namespace fenestra::core::testing::AccumulationStressTests
