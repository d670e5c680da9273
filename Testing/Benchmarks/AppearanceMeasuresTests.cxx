// Tests of the measures of appearance on images with a known defect.

#include "Benchmarks/AppearanceMeasures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace fenestra::core::benchmarks {
namespace {

constexpr int width = 100;
constexpr double pitch = 0.5; // mm per pixel

template <typename Value, typename Function>
Raster<Value> fill(const Function& function) {
  Raster<Value> raster(width, width);
  for (int row = 0; row < width; ++row)
    for (int column = 0; column < width; ++column)
      raster.at(column, row) = static_cast<Value>(function(column, row));
  return raster;
}

PixelMask makeDisc(double radius) {
  return fill<std::uint8_t>([radius](int column, int row) {
    return std::hypot(column - 50.0, row - 50.0) < radius ? 1 : 0;
  });
}

Raster<Lab> makeUniform(const Lab& color) {
  return Raster<Lab>(width, width, color);
}

/// Plane with a slope of 1, and terraces of this height, mm.
Raster<double> makeSlope(double terrace) {
  return fill<double>([terrace](int column, int) {
    const double depth = 500.0 + column * pitch;
    return terrace > 0.0 ? terrace * std::floor(depth / terrace) : depth;
  });
}

TEST(Morphology, DilateAndErodeByARadius) {
  PixelMask point(9, 9);
  point.at(4, 4) = 1;
  EXPECT_EQ(countPixels(dilate(point, 1.0)), 5U);
  EXPECT_EQ(countPixels(dilate(point, 2.9)), 25U);
  EXPECT_EQ(erode(dilate(point, 3.0), 2.99).values, point.values);
  // The image border is no outline.
  EXPECT_EQ(countPixels(erode(PixelMask(9, 9, 1), 3.0)), 81U);
}

TEST(Quantile, InterpolatesAndHasNoValueWithoutValues) {
  EXPECT_DOUBLE_EQ(quantile({3.0, 1.0, 2.0, 5.0}, 0.5), 2.5);
  EXPECT_DOUBLE_EQ(quantile({3.0, 1.0}, 0.95), 2.9);
  EXPECT_TRUE(std::isnan(quantile({}, 0.5)));
}

TEST(Stairs, InclinedPlaneHasNoneUpToItsOutline) {
  const auto stairs = measureStairs(makeSlope(0.0), makeDisc(40.0), pitch);
  ASSERT_TRUE(stairs);
  EXPECT_LT(stairs->p95, 0.3); // the median filter shifts depths at the outline a little
}

TEST(Stairs, TerracesOfAnInclinedPlaneDifferFromIt) {
  // Treads of 2.5 mm are normal to the camera axis, 45 degrees from the plane.
  const auto stairs = measureStairs(makeSlope(2.5), makeDisc(40.0), pitch);
  ASSERT_TRUE(stairs);
  EXPECT_GT(stairs->rms, 25.0);
  EXPECT_GT(stairs->p95, 35.0);
}

TEST(Stairs, WavesHaveTheAngleOfTheirSlope) {
  // Waves of 8 mm, which a Gaussian of 4 mm removes: slope 0.2 cos, rms angle 0.2 / sqrt(2).
  const Raster<double> depth = fill<double>([](int column, int) {
    const double frequency = 2.0 * pi / 8.0;
    return 0.2 / frequency * std::sin(frequency * column * pitch);
  });
  const auto stairs = measureStairs(depth, makeDisc(45.0), pitch);
  ASSERT_TRUE(stairs);
  EXPECT_NEAR(stairs->rms, 7.7, 0.4); // 8.1, damped by the median and by differences of two pixels
}

TEST(Stairs, IgnoreJumpsBetweenPartsAndTheOutline) {
  const Raster<double> depth =
      fill<double>([](int column, int) { return column < 50 ? 500.0 : 530.0; });
  const auto stairs = measureStairs(depth, makeDisc(49.0), pitch);
  ASSERT_TRUE(stairs);
  EXPECT_LT(stairs->p95, 1e-6);
  EXPECT_FALSE(measureStairs(depth, makeDisc(5.0), pitch));
}

TEST(Mottle, UniformRegionHasNoneBesideAnother) {
  const PixelMask disc = makeDisc(30.0);
  const Raster<Lab> image = fill<Lab>([&](int column, int row) {
    return disc.at(column, row) != 0 ? Lab{40.0, 20.0, 10.0} : Lab{90.0, 0.0, 0.0};
  });
  EXPECT_LT(measureMottle(image, disc, pitch).value(), 1e-9);
}

TEST(Mottle, CheckerboardHasItsAmplitude) {
  const Raster<Lab> image = fill<Lab>([](int column, int row) {
    const double sign = (column + row) % 2 == 0 ? 1.0 : -1.0;
    return Lab{50.0 + 2.0 * sign, 20.0 + sign, 10.0 - 2.0 * sign};
  });
  EXPECT_NEAR(measureMottle(image, makeDisc(30.0), pitch).value(), 3.0, 0.05);
  EXPECT_FALSE(measureMottle(image, makeDisc(3.0), pitch));
}

TEST(ToneMeasure, ExcludesDeepShadowsAndUncoveredPixels) {
  const Raster<Lab> image = fill<Lab>([](int column, int) {
    return column < 40 ? Lab{5.0, 0.0, 0.0} : Lab{column < 50 ? 30.0 : 80.0, 18.0, 24.0};
  });
  const PixelMask left = fill<std::uint8_t>([](int column, int) { return column < 50 ? 1 : 0; });
  const Tone tone = measureTone(image, left);
  EXPECT_DOUBLE_EQ(tone.dark, 30.0);
  EXPECT_DOUBLE_EQ(tone.light, 30.0);
  EXPECT_DOUBLE_EQ(tone.chroma, 30.0);
}

TEST(Highlights, AreLighterAndLessChromaticThanTheirSurroundings) {
  const PixelMask focus = makeDisc(45.0);
  Raster<Lab> image = makeUniform({40.0, 20.0, 15.0});
  EXPECT_EQ(measureHighlights(image, focus, pitch).value(), 0.0);
  for (int row = 48; row < 54; ++row)
    for (int column = 46; column < 56; ++column)
      image.at(column, row) = {55.0, 10.0, 8.0};
  const double all = static_cast<double>(countPixels(erode(focus, 6.0 / pitch)));
  EXPECT_NEAR(measureHighlights(image, focus, pitch).value(), 60.0 / all, 1e-9);
  for (Lab& lab : image.values)
    lab = lab.L > 50.0 ? Lab{55.0, 30.0, 25.0} : lab; // brighter, but more chromatic: a color
  EXPECT_EQ(measureHighlights(image, focus, pitch).value(), 0.0);
}

TEST(DarkEdge, CountsDarkPixelsAlongTheOutlineOnly) {
  const PixelMask focus = makeDisc(30.0);
  const PixelMask line = subtract(dilate(focus, 1.0), focus);
  Raster<Lab> image = makeUniform({50.0, 20.0, 10.0});
  image.at(50, 50).L = 10.0; // not at the outline
  EXPECT_EQ(measureDarkEdge(image, focus).value(), 0.0);
  for (std::size_t i = 0; i < image.values.size(); ++i)
    if (line.values[i] != 0)
      image.values[i].L = 38.0;
  EXPECT_NEAR(measureDarkEdge(image, focus).value(), 1.0 / 6.0, 0.03);
  EXPECT_FALSE(measureDarkEdge(image, PixelMask(width, width, 1)));
}

TEST(EdgeContrastMeasure, ComparesMeanColorsOnBothSides) {
  const PixelMask focus = makeDisc(30.0);
  const Raster<Rgb> gray(width, width, Rgb::Constant(0.5));
  const PixelMask all(width, width, 1);
  EXPECT_NEAR(measureContrast(gray, focus, all)->deltaE, 0.0, 1e-9);
  const Raster<Rgb> display = fill<Rgb>([&](int column, int row) -> Rgb {
    return Rgb::Constant(focus.at(column, row) != 0 ? 0.25 : 0.75);
  });
  const auto contrast = measureContrast(display, focus, all);
  ASSERT_TRUE(contrast);
  const double expected = toLabRaster(display).at(0, 0).L - toLabRaster(display).at(50, 50).L;
  EXPECT_NEAR(contrast->deltaE, expected, 1e-6);
  EXPECT_NEAR(contrast->deltaEDeutan, expected, 0.5);
  EXPECT_NEAR(contrast->deltaLightness, expected, 1e-6);
  EXPECT_FALSE(measureContrast(display, focus, focus)); // nothing outside counts
}

} // namespace
} // namespace fenestra::core::benchmarks
