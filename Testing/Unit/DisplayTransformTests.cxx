// Display views: properties of the tone curves, and alpha.

#include "files/images/DisplayTransform.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace fenestra::core::DisplayTransformTests {
namespace {

constexpr float infinite = std::numeric_limits<float>::infinity();
constexpr float notANumber = std::numeric_limits<float>::quiet_NaN();

/// Inverse of the sRGB encoding (IEC 61966-2-1).
double srgbToLinear(double v) {
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

/// Displayed values of one opaque pixel.
std::vector<float> displayPixel(DisplayView view, float r, float g, float b) {
  return toDisplay({r, g, b, 1.0f}, {view});
}

float displayGray(DisplayView view, float value) {
  const std::vector<float> rgba = displayPixel(view, value, value, value);
  constexpr float rounding = 4e-6f; // a quarter of a 16-bit step
  EXPECT_NEAR(rgba[0], rgba[1], view == DisplayView::film ? rounding : 0.0f);
  EXPECT_NEAR(rgba[0], rgba[2], view == DisplayView::film ? rounding : 0.0f);
  return rgba[0];
}

double computeGrayLight(DisplayView view, double value) {
  return srgbToLinear(static_cast<double>(displayGray(view, static_cast<float>(value))));
}

constexpr DisplayView photographic = DisplayView::photographic;
constexpr DisplayView film = DisplayView::film;

using Color = std::array<double, 3>;

/// Displayed light of one opaque pixel, linear.
Color computeLight(DisplayView view, const Color& c) {
  const std::vector<float> rgba = displayPixel(view, static_cast<float>(c[0]),
                                               static_cast<float>(c[1]), static_cast<float>(c[2]));
  return {srgbToLinear(double{rgba[0]}), srgbToLinear(double{rgba[1]}),
          srgbToLinear(double{rgba[2]})};
}

double luminance(const Color& c) {
  return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
}

/// Shoulder of the film curve: reaches 1 at 6.
double shoulder(double x) {
  return x * (1.0 + x / 36.0) / (1.0 + x);
}

/// Film contrast about middle gray, with the gain that compensates for the shoulder there.
Color applyContrast(Color c) {
  for (double& x : c)
    x = 1.21058 * 0.18 * std::pow(x / 0.18, 1.15);
  return c;
}

/// Specified film curve: 60 % of the shoulder on luminance, 40 % on channels.
Color blendShoulders(const Color& scene) {
  Color c = applyContrast(scene);
  const double y = luminance(c), scale = y > 0.0 ? shoulder(y) / y : 1.0;
  for (double& x : c)
    x = 0.6 * scale * x + 0.4 * shoulder(x);
  return c;
}

/// Implemented film curve: 0.4 of the roll-off on luminance, then the rest per channel.
Color applyFilmView(const Color& scene) {
  Color c = applyContrast(scene);
  const double scale = 1.0 / (1.0 + 0.4 * luminance(c));
  for (double& x : c) {
    const double y = x * scale;
    x = y < 2.4 ? std::min(1.0, shoulder(y / (1.0 - 0.4 * y))) : 1.0;
  }
  return c;
}

/// CIE 1976 L*a*b* of linear Rec. 709 under D65.
Color toCieLab(const Color& c) {
  const auto f = [](double t) { return t > 0.008856 ? std::cbrt(t) : 7.787 * t + 16.0 / 116.0; };
  const double x = f((0.4124 * c[0] + 0.3576 * c[1] + 0.1805 * c[2]) / 0.9505);
  const double y = f(luminance(c));
  const double z = f((0.0193 * c[0] + 0.1192 * c[1] + 0.9505 * c[2]) / 1.089);
  return {116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)};
}

double colorDifference(const Color& a, const Color& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/// sRGB gamut in six values per channel, exposed from -4 to +4 stops.
std::vector<Color> makeExposedGamut() {
  std::vector<Color> colors;
  for (int stops = -4; stops <= 4; ++stops)
    for (int i = 1; i < 216; ++i) {
      Color c = {i / 36 / 5.0, i / 6 % 6 / 5.0, i % 6 / 5.0};
      for (double& x : c)
        x = srgbToLinear(x) * std::exp2(stops);
      colors.push_back(c);
    }
  return colors;
}

} // namespace

TEST(PhotographicView, FollowsItsFormula) {
  const double a = 0.18;
  for (double x = 0.001; x < 4.0; x *= 1.1) {
    const double expected = x <= a ? x : 1.0 - (1.0 - a) * std::exp(-(x - a) / (1.0 - a));
    EXPECT_NEAR(computeGrayLight(photographic, x), expected, 2e-3) << x;
  }
}

TEST(PhotographicView, KeepsBlackAndMiddleGrayAndRollsOffBelowWhite) {
  EXPECT_EQ(displayGray(photographic, 0.0f), 0.0f);
  EXPECT_NEAR(computeGrayLight(photographic, 0.18), 0.18, 1e-3);
  EXPECT_GT(computeGrayLight(photographic, 4.0), 0.97);
  EXPECT_LT(computeGrayLight(photographic, 4.0), 0.995);
  EXPECT_EQ(std::lround(255.0f * displayGray(photographic, 65504.0f)), 255);
}

TEST(PhotographicView, IncreasesStrictlyUpTo4AndNeverDecreases) {
  float previous = 0.0f;
  for (double stops = -12.0; stops < 20.0; stops += 0.01) {
    const double x = 0.18 * std::exp2(stops);
    const float y = displayGray(photographic, static_cast<float>(x));
    if (x < 4.0) {
      EXPECT_GT(y, previous) << x;
      EXPECT_LT(y, 1.0f) << x;
    } else {
      EXPECT_GE(y, previous - 1e-6f) << x;
    }
    previous = y;
  }
}

TEST(PhotographicView, PreservesDarkTissueAndTheOrderOfChannels) {
  const std::vector<float> dark = displayPixel(photographic, 0.17f, 0.06f, 0.05f);
  EXPECT_NEAR(srgbToLinear(dark[0]), 0.17, 1e-3);
  EXPECT_NEAR(srgbToLinear(dark[1]), 0.06, 1e-3);
  EXPECT_NEAR(srgbToLinear(dark[2]), 0.05, 1e-3);
  for (const float exposure : {0.5f, 1.0f, 2.0f, 4.0f}) {
    const std::vector<float> muscle =
        displayPixel(photographic, 0.55f * exposure, 0.18f * exposure, 0.14f * exposure);
    EXPECT_GT(muscle[0], muscle[1]);
    EXPECT_GT(muscle[1], muscle[2]);
  }
}

TEST(FilmView, FollowsItsFormula) {
  for (const Color& c : makeExposedGamut()) {
    const Color light = computeLight(film, c), expected = applyFilmView(c);
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_NEAR(light[i], expected[i], 2e-3) << c[0] << " " << c[1] << " " << c[2];
  }
}

TEST(FilmView, ApproximatesABlendOfLuminanceAndChannelShoulders) {
  double sum = 0.0, maximum = 0.0;
  int count = 0;
  for (const Color& c : makeExposedGamut()) {
    const Color expected = blendShoulders(c);
    if (std::ranges::max(expected) > 1.0)
      continue; // the blend leaves the gamut
    const double difference = colorDifference(toCieLab(computeLight(film, c)), toCieLab(expected));
    sum += difference;
    maximum = std::max(maximum, difference);
    ++count;
  }
  EXPECT_GT(count, 1200);
  EXPECT_LT(sum / count, 1.3);
  EXPECT_LT(maximum, 10.5);
}

TEST(FilmView, KeepsBlackAndMiddleGrayAndShowsWhiteDarkerThanPhotographic) {
  EXPECT_EQ(displayPixel(film, 0.0f, 0.0f, 0.0f), (std::vector<float>{0.0f, 0.0f, 0.0f, 1.0f}));
  EXPECT_NEAR(computeGrayLight(film, 0.18), 0.18, 1e-3);
  EXPECT_NEAR(computeGrayLight(film, 1.0), 0.637, 2e-3);
  EXPECT_NEAR(computeGrayLight(photographic, 1.0), 0.698, 2e-3);
  EXPECT_LT(computeGrayLight(film, 3.0), 0.995);
  EXPECT_EQ(std::lround(255.0f * displayGray(film, 3.3f)), 255);
  EXPECT_GT(displayGray(film, 65504.0f), 0.999999f);
}

TEST(FilmView, IncreasesInEveryChannelWithBrightness) {
  for (const Color& hue : {Color{1, 1, 1}, Color{1, 0.3, 0.2}, Color{0, 0, 1}, Color{0, 1, 0.1}}) {
    Color previous = {};
    for (double stops = -12.0; stops < 20.0; stops += 0.02) {
      const double x = 0.18 * std::exp2(stops);
      const Color light = computeLight(film, {x * hue[0], x * hue[1], x * hue[2]});
      for (std::size_t i = 0; i < 3; ++i)
        EXPECT_GE(light[i], previous[i] - 4e-6) << x << " " << i;
      EXPECT_TRUE(std::ranges::max(light) > 0.9999 || luminance(light) > luminance(previous)) << x;
      previous = light;
    }
  }
}

TEST(StandardView, IsTheSrgbEncodingWithClipping) {
  constexpr DisplayView view = DisplayView::standard;
  for (const double x : {0.0, 0.001, 0.01, 0.18, 0.5, 0.9, 1.0})
    EXPECT_NEAR(computeGrayLight(view, x), x, 2e-5) << x;
  EXPECT_EQ(std::lround(65535.0f * displayGray(view, 1.5f)), 65535);
  EXPECT_LE(displayGray(view, 1.5f), 1.0f);
  EXPECT_EQ(displayGray(view, -0.5f), 0.0f);
}

TEST(DisplayTransform, ShowsNanAsBlackAndInfinityAsWhite) {
  for (const DisplayView view : {film, photographic, DisplayView::standard}) {
    EXPECT_EQ(displayGray(view, notANumber), 0.0f);
    EXPECT_EQ(displayGray(view, -infinite), 0.0f);
    EXPECT_GT(displayGray(view, infinite), 0.999f);
    EXPECT_GT(displayGray(view, std::numeric_limits<float>::max()), 0.999f);
  }
}

TEST(DisplayTransform, TreatsAllPixelsEqually) {
  const float gray = displayGray(photographic, 0.3f);
  std::vector<float> many;
  for (int i = 0; i < 1000; ++i)
    many.insert(many.end(), {0.3f, 0.3f, 0.3f, 1.0f});
  const std::vector<float> display = toDisplay(many, {photographic});
  for (std::size_t i = 0; i < display.size(); ++i)
    EXPECT_EQ(display[i], i % 4 == 3 ? 1.0f : gray);
  EXPECT_TRUE(toDisplay({}, {photographic}).empty());
}

TEST(DisplayTransform, IgnoresTheEnvironmentAndPrintsNothing) {
  ::setenv("OCIO", "/nowhere/config.ocio", 1);
  ::setenv("OCIO_ACTIVE_VIEWS", "Standard", 1);
  ::setenv("OCIO_ACTIVE_DISPLAYS", "Cinema", 1);
  ::testing::internal::CaptureStderr();
  const float gray = displayGray(photographic, 1.0f);
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  EXPECT_LT(gray, 0.9f); // photographic: Standard would clip 1 to 1
  ::unsetenv("OCIO");
  ::unsetenv("OCIO_ACTIVE_VIEWS");
  ::unsetenv("OCIO_ACTIVE_DISPLAYS");
}

TEST(ToDisplay, ExposureMultipliesRadianceBeforeTheToneCurve) {
  const std::vector<float> pixels = {0.04f, 0.02f, 0.3f, 0.5f};
  std::vector<float> brighter = pixels, darker = pixels;
  for (std::size_t c = 0; c < 3; ++c) {
    brighter[c] *= 4.0f;
    darker[c] /= 8.0f;
  }
  EXPECT_EQ(toDisplay(pixels, {photographic, 2.0}), toDisplay(brighter, {photographic}));
  EXPECT_EQ(toDisplay(pixels, {photographic, -3.0}), toDisplay(darker, {photographic}));
  EXPECT_EQ(toDisplay(pixels, {DisplayView::standard, 2.0}),
            toDisplay(pixels, {DisplayView::standard}));
  const float bright = toDisplay({infinite, infinite, infinite, 1.0f}, {photographic, -16.0})[0];
  EXPECT_GT(bright, 0.999f);
  EXPECT_EQ(toDisplay({notANumber, 0.0f, 0.0f, 1.0f}, {photographic, 16.0})[0], 0.0f);
}

TEST(ToDisplay, DividesByAlphaBeforeTheView) {
  const auto half = toDisplay({0.4f, 0.2f, 0.1f, 0.5f}, {photographic});
  const auto full = toDisplay({0.8f, 0.4f, 0.2f, 1.0f}, {photographic});
  for (std::size_t c = 0; c < 3; ++c)
    EXPECT_FLOAT_EQ(half[c], full[c]);
  EXPECT_EQ(half[3], 0.5f);
  EXPECT_EQ(full[3], 1.0f);
}

TEST(ToDisplay, TransparentIsBlackAndAlphaIsClampedTo0To1) {
  EXPECT_EQ(toDisplay({0.4f, 0.2f, 0.1f, 0.0f}, {photographic}),
            (std::vector<float>{0.0f, 0.0f, 0.0f, 0.0f}));
  EXPECT_EQ(toDisplay({0.4f, 0.2f, 0.1f, notANumber}, {photographic})[3], 0.0f);
  EXPECT_EQ(toDisplay({0.4f, 0.2f, 0.1f, 1.5f}, {photographic})[3], 1.0f);
}

} // namespace fenestra::core::DisplayTransformTests
