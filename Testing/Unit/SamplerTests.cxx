#include "base/Sampler.h"

#include "Histogram.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <set>

namespace fenestra::core::testing::SamplerTests {
namespace {

constexpr std::uint64_t size = Sampler::blockSize;
constexpr std::size_t dimensionCount = 8;
using Dimensions = std::array<double, dimensionCount>;

/// The stratified dimensions, in pairs.
Dimensions toDimensions(const PrimarySamples& numbers) {
  const Vec2 position = toUniform2(numbers.position);
  const Vec2 scattered = toUniform2(numbers.direction);
  const Vec2 choices = toUniform2(numbers.choices);
  return {position.x(),
          position.y(),
          toUniform(numbers.opticalDepth),
          toUniform(numbers.acceptance),
          scattered.x(),
          scattered.y(),
          choices.x(),
          choices.y()};
}

/// Number of the sample at an offset in a block of one half buffer. Samples alternate between the
/// two half buffers of the film.
std::uint64_t toSampleIndex(std::uint64_t block, std::uint64_t half, std::uint64_t offset) {
  return 2 * (block * size + offset) + half;
}

std::size_t findCell(double number, std::size_t cells) {
  return static_cast<std::size_t>(number * static_cast<double>(cells));
}

void expectUniform(const std::vector<double>& counts, const std::string& what) {
  double sum = 0.0;
  for (const double count : counts)
    sum += count;
  const std::vector<double> expected(counts.size(), sum / static_cast<double>(counts.size()));
  EXPECT_LT(std::abs(chiSquaredZScore(counts, expected)), 4.5) << what;
}

/// Expects the pairs that sample(pixel) returns to be uniform over `cells` x `cells` cells.
template <typename Sample>
void expectJointlyUniform(Sample&& sample, std::size_t cells, const std::string& what) {
  constexpr std::uint64_t pixels = 40000;
  std::vector<double> counts(cells * cells, 0.0);
  for (std::uint64_t pixel = 0; pixel < pixels; ++pixel) {
    const auto [a, b] = sample(pixel);
    counts[findCell(a, cells) * cells + findCell(b, cells)] += 1.0;
  }
  expectUniform(counts, what);
}

TEST(StratifiedSampler, BlockHitsEachStratumOnce) {
  const Sampler sampler(Sampling::stratified, 3);
  for (std::uint64_t pixel = 0; pixel < 200; ++pixel)
    for (std::uint64_t half = 0; half < 2; ++half)
      for (const std::uint64_t block : {0ULL, 1ULL, 5ULL, 1ULL << 40}) {
        std::array<std::set<std::size_t>, dimensionCount> strata;
        std::array<std::set<std::size_t>, dimensionCount> boxes; // of pair i: [2 i] and [2 i + 1]
        for (std::uint64_t offset = 0; offset < size; ++offset) {
          const Dimensions values =
              toDimensions(sampler.generate(pixel, toSampleIndex(block, half, offset)));
          for (std::size_t i = 0; i < dimensionCount; ++i)
            strata[i].insert(findCell(values[i], size));
          for (std::size_t i = 0; i < dimensionCount; i += 2) {
            boxes[i].insert(findCell(values[i], 2) * 4 + findCell(values[i + 1], 4));
            boxes[i + 1].insert(findCell(values[i], 4) * 2 + findCell(values[i + 1], 2));
          }
        }
        for (std::size_t i = 0; i < dimensionCount; ++i) {
          ASSERT_EQ(strata[i].size(), size) << "dimension " << i;
          ASSERT_EQ(boxes[i].size(), size) << "boxes " << i;
        }
      }
}

/// A single sample, at any offset in a block, is distributed like an independent sample.
TEST(StratifiedSampler, DimensionsOfASampleAreUniformAndIndependent) {
  for (const Sampling sampling : {Sampling::stratified, Sampling::independent}) {
    const Sampler sampler(sampling, 11);
    for (const std::uint64_t sample : {0ULL, 1ULL, 2ULL, 14ULL, 15ULL, 16ULL, 77ULL}) {
      for (std::size_t i = 0; i < dimensionCount; ++i)
        for (std::size_t j = i + 1; j < dimensionCount; ++j)
          expectJointlyUniform(
              [&](std::uint64_t pixel) {
                const Dimensions values = toDimensions(sampler.generate(pixel, sample));
                return std::array{values[i], values[j]};
              },
              16, std::to_string(sample) + ": " + std::to_string(i) + ", " + std::to_string(j));
      std::vector<double> orthants(256, 0.0); // lower or upper half of each dimension
      for (std::uint64_t pixel = 0; pixel < 40000; ++pixel) {
        std::size_t half = 0;
        for (const double number : toDimensions(sampler.generate(pixel, sample)))
          half = 2 * half + findCell(number, 2);
        orthants[half] += 1.0;
      }
      expectUniform(orthants, "orthants");
    }
  }
}

/// Two samples of a block are in different strata of every dimension; apart from that, their strata
/// in dimensions of different pairs are independent.
TEST(StratifiedSampler, PairsOfDimensionsAreShuffledIndependently) {
  const Sampler sampler(Sampling::stratified, 12);
  for (const std::uint64_t offset : {1ULL, 4ULL, 7ULL})
    for (const auto& [i, j] : {std::pair{0U, 4U}, {0U, 6U}, {2U, 6U}, {4U, 6U}}) {
      std::vector<double> counts((size - 1) * (size - 1), 0.0);
      for (std::uint64_t pixel = 0; pixel < 40000; ++pixel) {
        const Dimensions a = toDimensions(sampler.generate(pixel, toSampleIndex(0, 0, 0)));
        const Dimensions b = toDimensions(sampler.generate(pixel, toSampleIndex(0, 0, offset)));
        const std::size_t first = findCell(a[i], size) ^ findCell(b[i], size);
        const std::size_t second = findCell(a[j], size) ^ findCell(b[j], size);
        ASSERT_TRUE(first > 0 && second > 0);
        counts[(first - 1) * (size - 1) + second - 1] += 1.0;
      }
      // Factor 0 of Sampler::nets stands for 1, so factor 1 is twice as likely as others.
      for (const double count : counts)
        EXPECT_TRUE(count > 40000.0 / 64 * 0.8 && count < 40000.0 / 16 * 1.1) << count;
    }
}

TEST(StratifiedSampler, HalfBuffersAndBlocksAreIndependent) {
  const Sampler sampler(Sampling::stratified, 13);
  const std::uint64_t reference = toSampleIndex(0, 0, 3);
  for (std::uint64_t offset = 0; offset < size; ++offset)
    for (const std::uint64_t other :
         {toSampleIndex(0, 1, offset), toSampleIndex(1, 0, offset), toSampleIndex(1, 1, offset)})
      for (std::size_t i = 0; i < dimensionCount; ++i)
        expectJointlyUniform(
            [&](std::uint64_t pixel) {
              return std::array{toDimensions(sampler.generate(pixel, reference))[i],
                                toDimensions(sampler.generate(pixel, other))[i]};
            },
            size,
            std::to_string(i) + ": samples " + std::to_string(reference) + ", " +
                std::to_string(other));
}

TEST(StratifiedSampler, NeighborsAndSeedsAreIndependent) {
  for (const bool otherSeed : {false, true}) {
    const Sampler a(Sampling::stratified, 1);
    const Sampler b(Sampling::stratified, otherSeed ? 2 : 1);
    expectJointlyUniform(
        [&](std::uint64_t pixel) {
          return std::array{toUniform(a.generate(pixel, 4).opticalDepth),
                            toUniform(b.generate(pixel + (otherSeed ? 0 : 1), 4).opticalDepth)};
        },
        size, otherSeed ? "seeds" : "neighbors");
  }
}

TEST(IndependentSampler, SamplesAreIndependent) {
  const Sampler sampler(Sampling::independent, 14);
  EXPECT_EQ(sampler.samplesPerBlock(), 1U);
  for (const std::uint64_t other : {1ULL, 2ULL, 3ULL, 14ULL})
    for (std::size_t i = 0; i < dimensionCount; ++i)
      expectJointlyUniform(
          [&](std::uint64_t pixel) {
            return std::array{toDimensions(sampler.generate(pixel, 0))[i],
                              toDimensions(sampler.generate(pixel, other))[i]};
          },
          size, std::to_string(i) + ": " + std::to_string(other));
}

/// Stratification does not change the seed of a path's other dimensions. All its bits are uniform.
TEST(StratifiedSampler, PathSeedIsThatOfIndependentSampler) {
  const Sampler strata(Sampling::stratified, 15);
  const Sampler independent(Sampling::independent, 15);
  std::array<int, 64> ones = {};
  constexpr int count = 40000;
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::uint64_t pathSeed = strata.generate(i % 200, i / 200).pathSeed;
    ASSERT_EQ(pathSeed, independent.generate(i % 200, i / 200).pathSeed);
    for (std::size_t bit = 0; bit < 64; ++bit)
      ones[bit] += static_cast<int>(pathSeed >> bit & 1);
  }
  for (const int n : ones)
    EXPECT_NEAR(n, count / 2, 4.5 * std::sqrt(count) / 2);
}

TEST(SamplerConversion, EndsOfTheUnitIntervalGiveFiniteValues) {
  for (const std::uint64_t bits : {std::uint64_t{0}, ~std::uint64_t{0}}) {
    const double u = toUniform(bits);
    EXPECT_TRUE(u >= 0.0 && u < 1.0);
    EXPECT_TRUE((toUniform2(bits).array() >= 0.0).all() && (toUniform2(bits).array() < 1.0).all());
    EXPECT_TRUE(std::isfinite(toExponential(u)) && toExponential(u) >= 0.0);
  }
  EXPECT_NEAR(toExponential(0x1p-50) / 0x1p-50, 1.0, 1e-12) << "must be precise near 0";
}

} // namespace
} // namespace fenestra::core::testing::SamplerTests
