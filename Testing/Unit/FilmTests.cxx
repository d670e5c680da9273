#include "image/Film.h"

#include "base/Random.h"

#include <gtest/gtest.h>

namespace fenestra::core::testing::FilmTests {
namespace {

TEST(PixelSums, MeanAndStandardErrorEqualTwoPasses) {
  PixelSums sums;
  std::vector<double> values;
  for (int i = 0; i < 1000; ++i) {
    Random random(1, static_cast<std::uint64_t>(i), 0);
    values.push_back(1e6 + random.uniform()); // large offset: sums of squares would cancel
    PathSample sample;
    sample.radiance = Rgb::Constant(values.back());
    sums.add(sample);
  }
  double mean = 0.0;
  for (const double v : values)
    mean += v / 1000.0;
  double variance = 0.0;
  for (const double v : values)
    variance += (v - mean) * (v - mean) / 999.0;
  EXPECT_NEAR(sums.mean[0], mean, 1e-6);
  EXPECT_NEAR(sums.standardError()[0], std::sqrt(variance / 1000.0), 1e-9);
}

TEST(PixelSums, HalfBuffersAreMeansOfEvenAndOddSamples) {
  PixelSums sums;
  Rgb even = Rgb::Zero(), odd = Rgb::Zero();
  double evenAlpha = 0.0, oddAlpha = 0.0;
  for (int i = 0; i < 7; ++i) {
    Random random(2, static_cast<std::uint64_t>(i), 0);
    PathSample sample;
    sample.radiance = Rgb(random.uniform(), 10.0 * random.uniform(), i);
    sample.alpha = random.uniform();
    sums.add(sample);
    (i % 2 == 0 ? even : odd) += sample.radiance / (i % 2 == 0 ? 4.0 : 3.0);
    (i % 2 == 0 ? evenAlpha : oddAlpha) += sample.alpha / (i % 2 == 0 ? 4.0 : 3.0);
  }
  const HalfMeans halves = sums.halfMeans();
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(halves.even[c], even[c], 1e-12);
    EXPECT_NEAR(halves.odd[c], odd[c], 1e-12);
  }
  EXPECT_NEAR(halves.evenAlpha, evenAlpha, 1e-12);
  EXPECT_NEAR(halves.oddAlpha, oddAlpha, 1e-12);
}

TEST(PixelSums, OneSampleHasNoError) {
  PixelSums sums;
  EXPECT_EQ(sums.standardError()[0], 0.0);
  sums.add({});
  EXPECT_EQ(sums.standardError()[1], 0.0);
}

/// Standard error of samples in blocks, by its definition.
double computeError(const std::vector<double>& values, std::size_t block) {
  struct Block {
    double sum = 0.0, size = 0.0;
  };
  std::vector<Block> blocks(2 * (values.size() / 2 / block + 1));
  double mean = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    Block& to = blocks[i / 2 / block * 2 + i % 2];
    to.sum += values[i];
    to.size += 1.0;
    mean += values[i] / static_cast<double>(values.size());
  }
  double squares = 0.0, sizes = 0.0;
  for (const Block& b : blocks) {
    squares += std::pow(b.sum - b.size * mean, 2.0);
    sizes += b.size * b.size;
  }
  return std::sqrt(squares / (static_cast<double>(values.size() * values.size()) - sizes));
}

TEST(PixelSums, StandardErrorFollowsFromBlocks) {
  for (const std::uint32_t block : {2U, 4U, 8U}) {
    PixelSums sums, shifted;
    sums.blockSize = block;
    shifted.blockSize = block;
    std::vector<double> values;
    for (std::uint64_t i = 0; i < 70; ++i) {
      values.push_back(Random(3, i, 0).uniform());
      PathSample sample;
      sample.radiance = Rgb::Constant(values.back());
      sums.add(sample);
      sample.radiance += 1e6; // sums of squares would cancel
      shifted.add(sample);
      if (i == 0)
        continue;
      const double expected = computeError(values, block);
      ASSERT_TRUE(std::isfinite(expected));
      EXPECT_NEAR(sums.standardError()[0], expected, 1e-12) << i + 1 << " samples";
      EXPECT_NEAR(shifted.standardError()[0], expected, 1e-6) << i + 1 << " samples";
    }
  }
}

TEST(PixelSums, BlocksThatCancelHaveNoError) {
  PixelSums sums;
  sums.blockSize = 2;
  for (int i = 0; i < 16; ++i) {
    PathSample sample;
    sample.radiance = Rgb::Constant(i / 2 % 2 == 0 ? 1.0 : 3.0); // per half buffer: 1 3 1 3 ...
    sums.add(sample);
  }
  EXPECT_EQ(sums.standardError()[0], 0.0);
  EXPECT_GT(sums.m2[0], 0.0);
}

TEST(Film, NoiseFollowsItsDefinition) {
  Film film(1, 2);
  EXPECT_EQ(film.noise(), infinity);
  for (const double x : {1.0, 3.0}) {
    PathSample sample;
    sample.radiance = Rgb::Constant(x);
    film.at(0, 0).add(sample);
    film.at(0, 1).add({}); // black, without error
  }
  // se^2 = 1, x = 2: half of the pixels contribute 1 / 4.01.
  EXPECT_NEAR(film.noise(), std::sqrt(0.5 / 4.01), 1e-12);
}

} // namespace
} // namespace fenestra::core::testing::FilmTests
