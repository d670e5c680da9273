#include "base/Sampling.h"

#include "Histogram.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <set>

namespace fenestra::testing::SamplingTests {
namespace {

constexpr std::uint64_t size = NumberSource::blockSize;
constexpr std::size_t numberCount = 8;
using Eight = std::array<double, numberCount>;

/// The eight numbers that have strata, in pairs.
Eight eightOf(const SampleNumbers& numbers) {
  const Vec2 position = uniform2Of(numbers.position);
  const Vec2 scattered = uniform2Of(numbers.scattered);
  const Vec2 choices = uniform2Of(numbers.choices);
  return {position.x(),
          position.y(),
          uniformOf(numbers.depth),
          uniformOf(numbers.acceptance),
          scattered.x(),
          scattered.y(),
          choices.x(),
          choices.y()};
}

/// Sample number of a place in a block.
std::uint64_t sampleAt(std::uint64_t block, std::uint64_t half, std::uint64_t place) {
  return 2 * (block * size + place) + half;
}

std::size_t cellOf(double number, std::size_t cells) {
  return static_cast<std::size_t>(number * static_cast<double>(cells));
}

void expectEven(const std::vector<double>& counts, const std::string& what) {
  double sum = 0.0;
  for (const double count : counts)
    sum += count;
  const std::vector<double> expected(counts.size(), sum / static_cast<double>(counts.size()));
  EXPECT_LT(std::abs(chiSquaredDeviate(counts, expected)), 4.5) << what;
}

/// Counts of `cells` x `cells` cells of two numbers, drawn by draw(pixel).
template <typename Draw>
void expectJointlyUniform(Draw&& draw, std::size_t cells, const std::string& what) {
  constexpr std::uint64_t pixels = 40000;
  std::vector<double> counts(cells * cells, 0.0);
  for (std::uint64_t pixel = 0; pixel < pixels; ++pixel) {
    const auto [a, b] = draw(pixel);
    counts[cellOf(a, cells) * cells + cellOf(b, cells)] += 1.0;
  }
  expectEven(counts, what);
}

TEST(Strata, BlocksHitEachStratumOnce) {
  const NumberSource source(Sampling::strata, 3);
  for (std::uint64_t pixel = 0; pixel < 200; ++pixel)
    for (std::uint64_t half = 0; half < 2; ++half)
      for (const std::uint64_t block : {0ULL, 1ULL, 5ULL, 1ULL << 40}) {
        std::array<std::set<std::size_t>, numberCount> strata;
        std::array<std::set<std::size_t>, numberCount> boxes; // pair i: in [2 i] and [2 i + 1]
        for (std::uint64_t place = 0; place < size; ++place) {
          const Eight eight = eightOf(source.numbers(pixel, sampleAt(block, half, place)));
          for (std::size_t i = 0; i < numberCount; ++i)
            strata[i].insert(cellOf(eight[i], size));
          for (std::size_t i = 0; i < numberCount; i += 2) {
            boxes[i].insert(cellOf(eight[i], 2) * 4 + cellOf(eight[i + 1], 4));
            boxes[i + 1].insert(cellOf(eight[i], 4) * 2 + cellOf(eight[i + 1], 2));
          }
        }
        for (std::size_t i = 0; i < numberCount; ++i) {
          ASSERT_EQ(strata[i].size(), size) << "number " << i;
          ASSERT_EQ(boxes[i].size(), size) << "boxes " << i;
        }
      }
}

/// Each sample alone is drawn as an independent one is, at each place of a block.
TEST(Strata, NumbersOfASampleAreUniformAndIndependent) {
  for (const Sampling sampling : {Sampling::strata, Sampling::independent}) {
    const NumberSource source(sampling, 11);
    for (const std::uint64_t sample : {0ULL, 1ULL, 2ULL, 14ULL, 15ULL, 16ULL, 77ULL}) {
      for (std::size_t i = 0; i < numberCount; ++i)
        for (std::size_t j = i + 1; j < numberCount; ++j)
          expectJointlyUniform(
              [&](std::uint64_t pixel) {
                const Eight eight = eightOf(source.numbers(pixel, sample));
                return std::array{eight[i], eight[j]};
              },
              16, std::to_string(sample) + ": " + std::to_string(i) + ", " + std::to_string(j));
      std::vector<double> halves(256, 0.0); // of all eight numbers
      for (std::uint64_t pixel = 0; pixel < 40000; ++pixel) {
        std::size_t half = 0;
        for (const double number : eightOf(source.numbers(pixel, sample)))
          half = 2 * half + cellOf(number, 2);
        halves[half] += 1.0;
      }
      expectEven(halves, "halves");
    }
  }
}

/// Two samples of one block: no number of one tells more of a number of another pair of the other
/// than that they differ in their strata.
TEST(Strata, PairsOfNumbersAreShuffledApart) {
  const NumberSource source(Sampling::strata, 12);
  for (const std::uint64_t place : {1ULL, 4ULL, 7ULL})
    for (const auto& [i, j] : {std::pair{0U, 4U}, {0U, 6U}, {2U, 6U}, {4U, 6U}}) {
      std::vector<double> counts((size - 1) * (size - 1), 0.0);
      for (std::uint64_t pixel = 0; pixel < 40000; ++pixel) {
        const Eight a = eightOf(source.numbers(pixel, sampleAt(0, 0, 0)));
        const Eight b = eightOf(source.numbers(pixel, sampleAt(0, 0, place)));
        const std::size_t first = cellOf(a[i], size) ^ cellOf(b[i], size);
        const std::size_t second = cellOf(a[j], size) ^ cellOf(b[j], size);
        ASSERT_TRUE(first > 0 && second > 0);
        counts[(first - 1) * (size - 1) + second - 1] += 1.0;
      }
      // Two of eight random factors stand for 1.
      for (const double count : counts)
        EXPECT_TRUE(count > 40000.0 / 64 * 0.8 && count < 40000.0 / 16 * 1.1) << count;
    }
}

TEST(Strata, HalvesAndBlocksAreIndependent) {
  const NumberSource source(Sampling::strata, 13);
  const std::uint64_t here = sampleAt(0, 0, 3);
  for (std::uint64_t place = 0; place < size; ++place)
    for (const std::uint64_t other :
         {sampleAt(0, 1, place), sampleAt(1, 0, place), sampleAt(1, 1, place)})
      for (std::size_t i = 0; i < numberCount; ++i)
        expectJointlyUniform(
            [&](std::uint64_t pixel) {
              return std::array{eightOf(source.numbers(pixel, here))[i],
                                eightOf(source.numbers(pixel, other))[i]};
            },
            size,
            std::to_string(i) + ": samples " + std::to_string(here) + ", " + std::to_string(other));
}

TEST(Strata, NeighboursAndSeedsShareNothing) {
  for (const bool otherSeed : {false, true}) {
    const NumberSource a(Sampling::strata, 1);
    const NumberSource b(Sampling::strata, otherSeed ? 2 : 1);
    expectJointlyUniform(
        [&](std::uint64_t pixel) {
          return std::array{uniformOf(a.numbers(pixel, 4).depth),
                            uniformOf(b.numbers(pixel + (otherSeed ? 0 : 1), 4).depth)};
        },
        size, otherSeed ? "seeds" : "neighbours");
  }
}

TEST(Independent, SamplesShareNothing) {
  const NumberSource source(Sampling::independent, 14);
  EXPECT_EQ(source.block(), 1U);
  for (const std::uint64_t other : {1ULL, 2ULL, 3ULL, 14ULL})
    for (std::size_t i = 0; i < numberCount; ++i)
      expectJointlyUniform(
          [&](std::uint64_t pixel) {
            return std::array{eightOf(source.numbers(pixel, 0))[i],
                              eightOf(source.numbers(pixel, other))[i]};
          },
          size, std::to_string(i) + ": " + std::to_string(other));
}

/// Every bit of the seed of all further numbers is as often 0 as 1, and strata do not touch it.
TEST(Strata, TheRestIsAsWithoutThem) {
  const NumberSource strata(Sampling::strata, 15);
  const NumberSource plain(Sampling::independent, 15);
  std::array<int, 64> ones = {};
  constexpr int count = 40000;
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::uint64_t rest = strata.numbers(i % 200, i / 200).rest;
    ASSERT_EQ(rest, plain.numbers(i % 200, i / 200).rest);
    for (std::size_t bit = 0; bit < 64; ++bit)
      ones[bit] += static_cast<int>(rest >> bit & 1);
  }
  for (const int n : ones)
    EXPECT_NEAR(n, count / 2, 4.5 * std::sqrt(count) / 2);
}

TEST(Numbers, EndsOfTheUnitIntervalAreFinite) {
  for (const std::uint64_t bits : {std::uint64_t{0}, ~std::uint64_t{0}}) {
    const double u = uniformOf(bits);
    EXPECT_TRUE(u >= 0.0 && u < 1.0);
    EXPECT_TRUE((uniform2Of(bits).array() >= 0.0).all() && (uniform2Of(bits).array() < 1.0).all());
    EXPECT_TRUE(std::isfinite(toExponential(u)) && toExponential(u) >= 0.0);
  }
  EXPECT_NEAR(toExponential(0x1p-50) / 0x1p-50, 1.0, 1e-12) << "precise near 0";
}

} // namespace
} // namespace fenestra::testing::SamplingTests
