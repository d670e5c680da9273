// Filter on synthetic images with known exact values: what it preserves, its error estimate, and
// inputs that break the estimate.

#include "denoise/filter/Filter.h"

#include "base/Random.h"
#include "denoise/filter/ErrorEstimate.h"
#include "denoise/filter/WindowFit.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <functional>
#include <iostream>

namespace fenestra::core::testing::FilterTests {
namespace {

/// Image of three bands and waves: a linear function of its features, plus `unexplained` times a
/// pattern that no feature contains.
struct TestImage {
  int width = 96, height = 80;
  double unexplained = 0.3, noise = 0.5; ///< noise: standard deviation in a half buffer

  std::size_t count() const { return static_cast<std::size_t>(width * height); }
  static double band(int x) { return x < 30 ? 0.2 : x < 60 ? 1.0 : 0.5; }
  static double wave(int x, int y) { return std::sin(0.11 * x) * std::cos(0.17 * y); }
  static double pattern(int x, int y) { return std::sin(0.05 * x + 0.21 * y); }

  double exact(std::size_t channel, int x, int y) const {
    const double scale = 1.0 - 0.2 * static_cast<double>(channel);
    return scale * (1.0 + 0.8 * band(x) + 0.4 * wave(x, y) + unexplained * pattern(x, y));
  }
  std::size_t index(int x, int y) const { return static_cast<std::size_t>(y * width + x); }

  void fill(Plane& plane, const std::function<double(int, int)>& value) const {
    plane.resize(count());
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        plane[index(x, y)] = static_cast<float>(value(x, y));
  }

  FilterInput input(std::uint64_t seed) const {
    FilterInput in{width, height, {}, {}, {}, {}, std::vector<std::uint8_t>(count(), 1)};
    const auto gaussian = [&](std::size_t stream, int x, int y) {
      Random random(seed, index(x, y), stream);
      const Vec2 u = random.uniform2();
      return std::sqrt(-2.0 * std::log1p(-u.x())) * std::cos(2.0 * pi * u.y());
    };
    for (std::size_t c = 0; c < 4; ++c) {
      fill(in.even[c],
           [&](int x, int y) { return exact(c, x, y) + noise * gaussian(2 * c, x, y); });
      fill(in.odd[c],
           [&](int x, int y) { return exact(c, x, y) + noise * gaussian(2 * c + 1, x, y); });
      if (c < 3)
        fill(in.variance[c], [&](int, int) { return 0.5 * noise * noise; });
    }
    in.features.resize(2);
    fill(in.features[0], [&](int x, int) { return band(x); });
    fill(in.features[1], [&](int x, int y) { return 7.0 + 100.0 * wave(x, y); });
    return in;
  }

  /// Mean over pixels and colors of (x - exact)^2 / (exact^2 + 0.01).
  double relativeError(const FourPlanes& color) const {
    double sum = 0.0;
    for (std::size_t c = 0; c < 3; ++c)
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
          const double t = exact(c, x, y);
          sum += std::pow(static_cast<double>(color[c][index(x, y)]) - t, 2) / (t * t + 0.01);
        }
    return sum / (3.0 * static_cast<double>(count()));
  }
};

/// Estimated and exact relative squared error, and that of the raw image: means over several runs.
struct Errors {
  double estimated = 0.0, exact = 0.0, raw = 0.0;
};

Errors measureErrors(
    const TestImage& subject, int runs,
    const std::function<void(FilterInput&)>& modify = [](FilterInput&) {}) {
  Errors errors;
  for (int seed = 0; seed < runs; ++seed) {
    FilterInput input = subject.input(static_cast<std::uint64_t>(seed) + 1);
    FourPlanes raw = input.even;
    for (std::size_t c = 0; c < 4; ++c)
      for (std::size_t i = 0; i < subject.count(); ++i)
        raw[c][i] = 0.5F * (input.even[c][i] + input.odd[c][i]);
    modify(input);
    const FilteredImage image = filterImage(input);
    errors.estimated += image.estimatedError / runs;
    errors.exact += subject.relativeError(image.color) / runs;
    errors.raw += subject.relativeError(raw) / runs;
  }
  return errors;
}

TEST(Filter, ImageLinearInItsFeaturesIsUnchanged) {
  const TestImage subject{.unexplained = 0.0, .noise = 0.0};
  const FilteredImage image = filterImage(subject.input(1));
  EXPECT_LT(std::sqrt(subject.relativeError(image.color)), 1e-3);
  EXPECT_LT(image.estimatedError, 1e-6);
}

TEST(Filter, ReducesErrorAndEstimatesItWithoutBias) {
  const Errors errors = measureErrors({.width = 192, .height = 160}, 12);
  EXPECT_GT(errors.raw / errors.exact, 10.0);
  EXPECT_NEAR(errors.estimated / errors.exact, 1.0, 0.15);
}

TEST(ErrorEstimate, OfOneWindowIsUnbiased) {
  const TestImage subject{.width = 384, .height = 320};
  const int runs = 8;
  double estimated = 0.0, exact = 0.0;
  for (int seed = 0; seed < runs; ++seed) {
    const FilterInput input = subject.input(static_cast<std::uint64_t>(seed) + 100);
    FitInput fit{subject.width, subject.height, Plane(subject.count(), 1.0F), {}, {}};
    fit.color = {input.even[0], input.odd[0]};
    subject.fill(fit.features.emplace_back(), [](int x, int) { return TestImage::band(x); });
    const auto fits = fitWindows(fit, 0);
    for (int y = 0; y < subject.height; ++y)
      for (int x = 0; x < subject.width; ++x) {
        const std::size_t i = subject.index(x, y);
        const ErrorEstimate estimate =
            estimateError(fits[0][i], fits[1][i], fit.color[0][i], fit.color[1][i]);
        estimated += static_cast<double>(estimate.variance + estimate.bias);
        const double mean = 0.5 * static_cast<double>(fits[0][i] + fits[1][i]);
        exact += std::pow(mean - subject.exact(0, x, y), 2);
      }
  }
  EXPECT_NEAR(estimated / exact, 1.0, 0.15) << "four standard errors";
}

/// The choice of a pixel's window must not depend on its noise: CandidateScorer leaves it out.
TEST(ErrorEstimate, OfTheChosenWindowsIsUnbiased) {
  const TestImage subject{.width = 192, .height = 160, .unexplained = 0.6, .noise = 1.0};
  double estimated = 0.0, exact = 0.0;
  for (std::uint64_t seed = 0; seed < 16; ++seed) {
    FilterInput input = subject.input(seed + 500);
    FitInput fit{subject.width, subject.height, Plane(subject.count(), 1.0F), {}, {}};
    for (std::size_t c = 0; c < 6; ++c)
      fit.color.push_back(c < 3 ? input.even[c] : input.odd[c - 3]);
    subject.fill(fit.features.emplace_back(), [](int x, int) { return TestImage::band(x); });
    subject.fill(fit.features.emplace_back(), TestImage::wave);
    const auto filtered = filterAdaptively(fit, input.variance);
    for (int y = 0; y < subject.height; ++y)
      for (int x = 0; x < subject.width; ++x) {
        const std::size_t i = subject.index(x, y);
        const auto mean = [i](const std::vector<Plane>& color, std::size_t first) {
          return (color[first][i] + color[first + 1][i] + color[first + 2][i]) / 3.0F;
        };
        const float even = mean(filtered, 0), odd = mean(filtered, 3);
        const ErrorEstimate estimate =
            estimateError(even, odd, mean(fit.color, 0), mean(fit.color, 3));
        estimated += static_cast<double>(estimate.variance + estimate.bias);
        const double m =
            (subject.exact(0, x, y) + subject.exact(1, x, y) + subject.exact(2, x, y)) / 3.0;
        exact += std::pow(0.5 * static_cast<double>(even + odd) - m, 2);
      }
  }
  std::cout << "estimated / exact " << estimated / exact << "\n";
  EXPECT_NEAR(estimated / exact, 1.0, 0.1);
}

TEST(Filter, FeaturesWithTheNoiseOfTheSamplesBiasTheEstimate) {
  const Errors errors = measureErrors({}, 4, [](FilterInput& input) {
    for (std::size_t i = 0; i < input.pixelCount(); ++i)
      input.features[0][i] = 0.5F * (input.even[0][i] + input.odd[0][i]);
  });
  EXPECT_LT(errors.estimated / errors.exact, 0.7);
}

TEST(Filter, EstimatedErrorsOfPixelsAverageToThatOfTheImage) {
  const TestImage subject;
  const FilteredImage image = filterImage(subject.input(3));
  double sum = 0.0;
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < subject.count(); ++i) {
      const double x = static_cast<double>(image.color[c][i]);
      sum += std::pow(static_cast<double>(image.error[c][i]), 2) / (x * x + 0.01);
    }
  EXPECT_NEAR(sum / (3.0 * static_cast<double>(subject.count())) / image.estimatedError, 1.0, 0.02);
}

TEST(Filter, BitsAreTheSameForOneTwoAndSevenThreads) {
  const FilterInput input = TestImage{.width = 200, .height = 150}.input(2);
  std::vector<FourPlanes> images;
  for (const std::size_t threads : {1U, 2U, 7U}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    images.push_back(filterImage(input).color);
  }
  EXPECT_EQ(images[0], images[1]);
  EXPECT_EQ(images[0], images[2]);
}

TEST(Filter, NoiseAroundAConstantCreatesNoStructure) {
  const TestImage noisy{.unexplained = 0.0};
  FilterInput input = noisy.input(5);
  const auto removeSignal = [&](Plane& plane, std::size_t c) {
    for (int y = 0; y < noisy.height; ++y)
      for (int x = 0; x < noisy.width; ++x)
        plane[noisy.index(x, y)] += static_cast<float>(2.0 - noisy.exact(c, x, y));
  };
  for (std::size_t c = 0; c < 4; ++c) {
    removeSignal(input.even[c], c);
    removeSignal(input.odd[c], c);
  }
  const FilteredImage image = filterImage(input);
  const double rawError = noisy.noise / std::sqrt(2.0);
  double outliers = 0.0, worst = 0.0;
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < noisy.count(); ++i) {
      const double difference = std::abs(static_cast<double>(image.color[c][i]) - 2.0);
      worst = std::max(worst, difference / rawError);
      outliers += difference > 5.0 * static_cast<double>(image.error[c][i]);
    }
  EXPECT_LT(worst, 2.0) << "raw standard errors";
  const double fraction = outliers / (3.0 * static_cast<double>(noisy.count()));
  std::cout << "beyond five estimated errors: " << 100.0 * fraction << " %\n";
  EXPECT_LT(fraction, 0.05);
}

TEST(Filter, FireflyIsNotWorseThanRaw) {
  const Errors errors = measureErrors({}, 1, [](FilterInput& input) {
    input.even[0][4000] += 1e6F;
    input.variance[0][4000] = 0.25e12F;
  });
  const double firefly = std::pow(0.5e6, 2) / (3.0 * static_cast<double>(TestImage().count()));
  EXPECT_LT(errors.exact, 1.02 * firefly);
  EXPECT_TRUE(std::isfinite(errors.estimated));
}

TEST(Filter, InactiveAndNonFinitePixelsStayRaw) {
  const TestImage subject{.width = 40, .height = 30};
  FilterInput input = subject.input(1);
  input.isActive[100] = 0;
  input.features[1][200] = std::numeric_limits<float>::quiet_NaN();
  input.even[2][300] = std::numeric_limits<float>::infinity();
  const FilteredImage image = filterImage(input);
  for (const std::size_t pixel : {100U, 200U})
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_EQ(image.color[c][pixel], 0.5F * (input.even[c][pixel] + input.odd[c][pixel]));
      EXPECT_EQ(image.error[c][pixel], std::sqrt(input.variance[c][pixel]));
    }
  for (const std::size_t pixel : {101U, 201U, 301U})
    EXPECT_TRUE(std::isfinite(image.color[2][pixel]));
  FilterInput inactive = subject.input(1);
  std::ranges::fill(inactive.isActive, std::uint8_t{0});
  EXPECT_GT(filterImage(inactive).estimatedError, 0.1); // error of the samples
  for (Plane& plane : inactive.variance)
    std::ranges::fill(plane, 0.0F); // deterministic
  EXPECT_EQ(filterImage(inactive).estimatedError, 0.0);
}

TEST(Filter, AcceptsImagesOfAnySize) {
  for (const auto& [width, height] : {std::pair(1, 1), {1, 50}, {70, 1}, {3, 2}, {65, 129}}) {
    const TestImage subject{.width = width, .height = height};
    for (const bool hasHalfBuffers : {true, false}) {
      FilterInput input = subject.input(1);
      input.hasHalfBuffers = hasHalfBuffers;
      if (!hasHalfBuffers)
        input.odd = {};
      const FilteredImage image = filterImage(input);
      EXPECT_TRUE(std::isfinite(subject.relativeError(image.color))) << width << 'x' << height;
      EXPECT_EQ(image.error[0].size(), hasHalfBuffers ? subject.count() : 0U);
    }
  }
}

/// Half of the image is black without noise, the other half a million times as bright. Windows
/// overlap both, and sums that should be 0 keep a rounding error.
TEST(Filter, BlackBesideBrightHasAFiniteAndAttainableErrorEstimate) {
  const TestImage subject;
  FilterInput input = subject.input(8);
  for (std::size_t c = 0; c < 3; ++c)
    for (int y = 0; y < subject.height; ++y)
      for (int x = 0; x < subject.width; ++x) {
        const std::size_t i = subject.index(x, y);
        const float scale = x < 40 ? 0.0F : 1e6F;
        input.even[c][i] *= scale;
        input.odd[c][i] *= scale;
        input.variance[c][i] *= scale * scale;
      }
  const FilteredImage image = filterImage(input);
  double estimated = 0.0, remaining = 0.0; // squares, summed over the black half
  for (std::size_t c = 0; c < 3; ++c)
    for (int y = 0; y < subject.height; ++y)
      for (int x = 0; x < subject.width; ++x) {
        const std::size_t i = subject.index(x, y);
        const auto error = static_cast<double>(image.error[c][i]);
        ASSERT_TRUE(error >= 0.0 && std::isfinite(error));
        estimated += x < 40 ? error * error : 0.0;
        remaining += x < 40 ? std::pow(static_cast<double>(image.color[c][i]), 2) : 0.0;
      }
  EXPECT_LT(image.estimatedError, 1.0);
  EXPECT_GT(estimated, 0.25 * remaining) << "estimated errors are at least half of what remains";
}

TEST(Filter, ImageWithoutFeaturesIsFilteredByMeans) {
  const Errors errors =
      measureErrors({.unexplained = 0.0}, 1, [](FilterInput& in) { in.features.clear(); });
  EXPECT_LT(errors.exact, errors.raw);
}

} // namespace
} // namespace fenestra::core::testing::FilterTests
