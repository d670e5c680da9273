// Comparisons of images with known statistics.

#include "Agreement.h"
#include "ErrorChecks.h"
#include "base/Random.h"
#include "files/images/ImageReader.h"
#include "image/Compare.h"

#include <gtest/gtest.h>

#include <filesystem>

namespace fenestra::core::CompareTests {
namespace {

Image makeConstantImage(int width, int height, float value) {
  const std::vector<float> plane(static_cast<std::size_t>(width * height), value);
  return {width, height, {{"R", plane}, {"G", plane}, {"B", plane}}, {}};
}

Image withError(Image image, float error) {
  for (const char* name : {"error.R", "error.G", "error.B"})
    image.channels[name].assign(image.channels["R"].size(), error);
  return image;
}

/// Image of normally distributed values (Box and Muller 1958).
Image makeNoisyImage(int size, float mean, float deviation, std::uint64_t seed) {
  Image image = makeConstantImage(size, size, mean);
  Random random(seed, 0, 0);
  for (auto& [name, plane] : image.channels)
    for (float& value : plane)
      value += deviation * static_cast<float>(std::sqrt(2.0 * random.exponential()) *
                                              std::cos(2.0 * pi * random.uniform()));
  return withError(image, deviation);
}

TEST(CompareImages, ConstantDifferenceHasKnownMetrics) {
  const Comparison c = compareImages(makeConstantImage(5, 3, 0.6f), makeConstantImage(5, 3, 0.5f));
  EXPECT_NEAR(c.relMse, 0.01 / 0.26, 1e-7);
  EXPECT_NEAR(c.rmse, 0.1, 1e-7);
  EXPECT_NEAR(c.psnr, 20.0, 1e-5);
  EXPECT_NEAR(c.maxDifference, 0.1, 1e-7);
  EXPECT_NEAR(c.meanA[1], 0.6, 1e-7);
  EXPECT_NEAR(c.meanB[2], 0.5, 1e-7);
  EXPECT_EQ(c.notFinite, 0u);
  EXPECT_FALSE(c.z.has_value());
}

TEST(CompareImages, EqualImagesHaveNoDifference) {
  const Image image = makeConstantImage(4, 4, 0.25f);
  const Comparison c = compareImages(image, image);
  EXPECT_EQ(c.relMse, 0.0);
  EXPECT_EQ(c.rmse, 0.0);
  EXPECT_EQ(c.psnr, infinity);
  EXPECT_EQ(c.maxDifference, 0.0);
}

TEST(CompareImages, RelMseExcludesTheVarianceOfTheReference) {
  const Image reference = makeNoisyImage(200, 1.0f, 0.01f, 1);
  const Image exact = makeConstantImage(200, 200, 1.0f);
  const double ownVariance = 1e-4 / 1.01;
  // Mean of 120000 squared normal values.
  const double tolerance = 5.0 * ownVariance * std::sqrt(2.0 / 120000.0);
  EXPECT_NEAR(compareImages(exact, reference).relMse, 0.0, tolerance);
  Image withoutErrors = reference;
  withoutErrors.channels.erase("error.G");
  EXPECT_NEAR(compareImages(exact, withoutErrors).relMse, ownVariance, tolerance);
}

TEST(CompareImages, CorrectErrorsGiveNormalZ) {
  const Comparison c =
      compareImages(makeNoisyImage(200, 1.0f, 0.03f, 1), makeNoisyImage(200, 1.0f, 0.04f, 2));
  ASSERT_TRUE(c.z.has_value());
  EXPECT_EQ(c.z->count, 120000u);
  EXPECT_NEAR(c.z->mean, 0.0, 5.0 / std::sqrt(120000.0));
  EXPECT_NEAR(c.z->deviation, 1.0, 5.0 / std::sqrt(240000.0));
  EXPECT_NEAR(c.z->fractionAbove3, 0.0027, 5.0 * std::sqrt(0.0027 / 120000.0));
  EXPECT_LT(c.z->imageMean.abs().maxCoeff(), 4.5);
}

TEST(CompareImages, ImageMeanShowsABiasThatSinglePixelsDoNot) {
  const Comparison c =
      compareImages(makeNoisyImage(200, 1.001f, 0.03f, 1), makeNoisyImage(200, 1.0f, 0.04f, 2));
  EXPECT_NEAR(c.z->imageMean.mean(), 0.001 / (0.05 / 200.0), 3.0); // 4 standard errors
  EXPECT_NEAR(c.z->deviation, 1.0, 0.02);
}

TEST(CompareImages, LargestZReportsItsPixelAndChannel) {
  Image a = withError(makeConstantImage(7, 4, 1.0f), 0.3f);
  const Image b = withError(makeConstantImage(7, 4, 1.0f), 0.4f);
  a.channels["G"][2 * 7 + 5] = -1.0f;
  const Comparison c = compareImages(a, b);
  EXPECT_NEAR(c.z->largest, 4.0, 1e-6);
  EXPECT_EQ(c.z->column, 5);
  EXPECT_EQ(c.z->row, 2);
  EXPECT_EQ(c.z->channel, 'G');
  EXPECT_NEAR(c.z->fractionAbove3, 1.0 / 84.0, 1e-12);
  EXPECT_NEAR(c.z->mean, -4.0 / 84.0, 1e-6);
}

TEST(CompareImages, ZSkipsOnlyPixelsWithBothErrorsZero) {
  const Image a = withError(makeConstantImage(2, 1, 1.0f), 0.0f);
  Image b = withError(makeConstantImage(2, 1, 0.5f), 0.0f);
  EXPECT_EQ(compareImages(a, b).z->count, 0u);
  EXPECT_EQ(compareImages(a, b).z->imageMean[0], infinity);
  EXPECT_EQ(compareImages(a, a).z->imageMean[0], 0.0);
  b.channels["error.R"][1] = 0.25f;
  EXPECT_EQ(compareImages(a, b).z->count, 1u);
  EXPECT_EQ(compareImages(a, b).z->mean, 2.0);
  EXPECT_EQ(compareImages(a, b).z->deviation, 0.0);
}

TEST(CompareImages, ZSkipsEqualValuesWithOneErrorZero) {
  const Image a = withError(makeConstantImage(2, 1, 0.2f), 0.0f);
  const Image b = withError(makeConstantImage(2, 1, 0.2f), 5e-4f);
  EXPECT_EQ(compareImages(a, b).z->count, 0u);
  const Image c = withError(makeConstantImage(2, 1, 0.2001f), 5e-4f);
  EXPECT_EQ(compareImages(a, c).z->count, 6u);
}

TEST(CompareImages, NonFiniteValuesAffectTheMetrics) {
  const Image b = makeConstantImage(3, 3, 1.0f);
  Image a = b;
  a.channels["G"][4] = std::numeric_limits<float>::quiet_NaN();
  const Comparison withNan = compareImages(a, b);
  EXPECT_EQ(withNan.notFinite, 1u);
  EXPECT_TRUE(std::isnan(withNan.relMse));
  EXPECT_TRUE(std::isnan(withNan.maxDifference));
  a.channels["G"][4] = std::numeric_limits<float>::infinity();
  EXPECT_EQ(compareImages(a, b).relMse, infinity);
  EXPECT_EQ(compareImages(b, a).notFinite, 1u);
}

TEST(CompareImages, RejectsDifferentSizesAndMissingChannels) {
  catchError(ErrorKind::input, "invalid-file | 2x3 | 3x2",
             [&] { compareImages(makeConstantImage(2, 3, 1.0f), makeConstantImage(3, 2, 1.0f)); });
  Image gray = makeConstantImage(2, 3, 1.0f);
  gray.channels.erase("B");
  catchError(ErrorKind::input, "invalid-file | R, G and B",
             [&] { compareImages(gray, makeConstantImage(2, 3, 1.0f)); });
}

TEST(DifferenceImage, PositiveIsRedAndNegativeIsBlue) {
  const Image b = makeConstantImage(3, 1, 1.0f);
  Image a = b;
  for (const char* name : {"R", "G", "B"})
    a.channels[name] = {1.0f, 1.5f, 0.75f};
  const Image difference = differenceImage(a, b);
  EXPECT_EQ(difference.channels.at("R"), (std::vector<float>{1.0f, 1.0f, 0.5f}));
  EXPECT_EQ(difference.channels.at("G"), (std::vector<float>{1.0f, 0.0f, 0.5f}));
  EXPECT_EQ(difference.channels.at("B"), (std::vector<float>{1.0f, 0.0f, 1.0f}));
}

TEST(DifferenceImage, WithErrorsShowsTheLargestZOfAPixel) {
  const Image b = withError(makeConstantImage(3, 1, 1.0f), 0.4f);
  Image a = withError(b, 0.3f);
  a.channels["G"] = {1.0f, 2.25f, 1.0f}; // z 2.5, half of full color
  a.channels["B"] = {1.0f, 1.5f, std::numeric_limits<float>::quiet_NaN()};
  const Image difference = differenceImage(a, b);
  EXPECT_NEAR(difference.channels.at("R")[1], 1.0, 1e-6);
  EXPECT_NEAR(difference.channels.at("B")[1], 0.5, 1e-6);
  EXPECT_EQ(difference.channels.at("R")[0], 1.0f);
  EXPECT_EQ(difference.channels.at("R")[2], 0.0f);
  EXPECT_EQ(difference.channels.at("B")[2], 0.0f);
}

TEST(AttachError, ErrorImageBecomesErrorChannels) {
  Image image = makeConstantImage(2, 2, 1.0f);
  attachError(image, makeConstantImage(2, 2, 0.125f));
  for (const char* name : {"error.R", "error.G", "error.B"})
    EXPECT_EQ(image.channels.at(name), std::vector<float>(4, 0.125f));
  EXPECT_THROW(attachError(image, makeConstantImage(1, 4, 0.125f)), Error);
}

TEST(AttachError, VarianceOfTheReferenceEqualsThatInItsReadme) {
  const std::filesystem::path folder = FENESTRA_REFERENCE;
  if (!std::filesystem::exists(folder / "S1_best.exr"))
    GTEST_SKIP() << "no reference images in " << folder;
  Image reference = readImage(folder / "S1_best.exr");
  attachError(reference, readImage(folder / "S1_best_se.exr"));
  Image withoutErrors = reference;
  for (const char* name : {"error.R", "error.G", "error.B"})
    withoutErrors.channels.erase(name);
  // The README of the reference states a relative variance of 7e-5.
  const double ownVariance = -compareImages(withoutErrors, reference).relMse;
  EXPECT_GT(ownVariance, 6e-5);
  EXPECT_LT(ownVariance, 8e-5);
}

// ---- probability that two renders show the same scene
// -----------------------------------------------------------

Image withSamples(Image image, float samples) {
  image.channels["samples.N"].assign(image.channels["R"].size(), samples);
  return image;
}

/// Render of a constant image with correct errors, independent for each seed.
Image makeRender(std::uint64_t seed, float mean = 0.5f) {
  return withSamples(makeNoisyImage(32, mean, 0.01f, seed), 1e4f);
}

TEST(StudentTail, MatchesClosedForms) {
  EXPECT_DOUBLE_EQ(studentTail(0.0, 5.0), 1.0);
  for (const double t : {0.3, 1.0, 4.0, 50.0}) {
    EXPECT_NEAR(studentTail(t, 1.0) / (1.0 - 2.0 / pi * std::atan(t)), 1.0, 1e-9);
    EXPECT_NEAR(studentTail(-t, 2.0) / (1.0 - t / std::sqrt(2.0 + t * t)), 1.0, 1e-9);
  }
  for (const double t : {0.3, 1.0, 4.0, 6.0}) // the limit is normal
    EXPECT_NEAR(studentTail(t, 1e8) / std::erfc(t / std::sqrt(2.0)), 1.0, 1e-4);
  EXPECT_EQ(studentTail(infinity, 7.0), 0.0);
}

TEST(TileMeans, HaveTheMeanAndErrorOfTheTile) {
  Image image = withSamples(withError(makeConstantImage(5, 4, 1.0f), 0.2f), 11.0f);
  image.channels["R"][0] = 5.0f;
  const Image tiles = computeTileMeans(image, 4);
  ASSERT_EQ(tiles.width, 2);
  ASSERT_EQ(tiles.height, 1);
  EXPECT_FLOAT_EQ(tiles.find("R")->at(0), 1.25f);
  EXPECT_FLOAT_EQ(tiles.find("R")->at(1), 1.0f);
  EXPECT_FLOAT_EQ(tiles.find("error.G")->at(0), 0.05f);
  EXPECT_FLOAT_EQ(tiles.find("error.G")->at(1), 0.1f);
  EXPECT_FLOAT_EQ(tiles.find("samples.N")->at(0), 176.0f);
  EXPECT_EQ(computeTileMeans(image, 1000).find("R")->size(), 1u);
  EXPECT_THROW(computeTileMeans(makeConstantImage(2, 2, 1.0f), 2), Error);
}

TEST(AgreementProbability, IndependentRendersGiveUniformProbabilities) {
  int lowCount = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed)
    lowCount += computeAgreement(makeRender(2 * seed), makeRender(2 * seed + 1)) < 0.1;
  EXPECT_NEAR(lowCount, 20, 4 * std::sqrt(20 * 0.9));
}

TEST(AgreementProbability, OneOutlierGivesNearlyZero) {
  Image image = makeRender(1);
  image.channels["G"][77] += 0.1f; // seven combined errors
  EXPECT_LT(computeAgreement(image, makeRender(2)), 1e-6);
  image.channels["G"][77] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(computeAgreement(image, makeRender(2)), 0.0);
}

TEST(AgreementProbability, IsOneForIdenticalValuesWithZeroError) {
  const Image black = withSamples(withError(makeConstantImage(4, 4, 0.0f), 0.0f), 9.0f);
  EXPECT_EQ(computeAgreement(black, black), 1.0);
  Image other = black;
  other.channels["B"][3] = 0.5f;
  EXPECT_EQ(computeAgreement(black, other), 0.0);
  other.channels["error.B"][3] = 0.5f; // one of a few samples hit something
  EXPECT_GT(computeAgreement(black, other), 0.05);
}

TEST(AgreementProbability, RareBrightPathsDoNotDisagree) {
  // One path in 200 is bright, at 100 and 800 samples. Several of the 4096 pixels then have four
  // bright paths of 100, which a normal distribution would exclude.
  const auto makeSparseImage = [](std::uint64_t seed, int samples) {
    Image image =
        withSamples(withError(makeConstantImage(64, 64, 0.0f), 0.0f), static_cast<float>(samples));
    Random random(seed, 0, 0);
    for (const std::string channel : {"R", "G", "B"})
      for (std::size_t i = 0; i < 4096; ++i) {
        double hits = 0.0;
        for (int n = 0; n < samples; ++n)
          hits += random.uniform() < 0.005;
        const double mean = hits / samples;
        image.channels[channel][i] = static_cast<float>(mean);
        image.channels["error." + channel][i] =
            static_cast<float>(std::sqrt(mean * (1.0 - mean) / (samples - 1)));
      }
    return image;
  };
  const Image reference = makeSparseImage(99, 800);
  for (std::uint64_t seed = 0; seed < 10; ++seed)
    EXPECT_GT(computeAgreement(makeSparseImage(seed, 100), reference), 0.01);
}

} // namespace
} // namespace fenestra::core::CompareTests
