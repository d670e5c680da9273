// Display views: properties of the tone curve, and alpha.

#include "files/pictures/DisplayTransform.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>

namespace fenestra::DisplayTransformTests {
namespace {

constexpr float infinite = std::numeric_limits<float>::infinity();
constexpr float notANumber = std::numeric_limits<float>::quiet_NaN();

/// Inverse of the sRGB encoding (IEC 61966-2-1).
double decodedSrgb(double v) {
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

/// Display values of one opaque pixel.
std::vector<float> shown(DisplayView view, float r, float g, float b) {
  return toDisplay({r, g, b, 1.0f}, {view});
}

float shownGrey(DisplayView view, float value) {
  const std::vector<float> rgba = shown(view, value, value, value);
  EXPECT_EQ(rgba[0], rgba[1]);
  EXPECT_EQ(rgba[0], rgba[2]);
  return rgba[0];
}

double displayLight(DisplayView view, double value) {
  return decodedSrgb(static_cast<double>(shownGrey(view, static_cast<float>(value))));
}

constexpr DisplayView photographic = DisplayView::photographic;

} // namespace

TEST(PhotographicView, FollowsItsFormula) {
  const double a = 0.18;
  for (double x = 0.001; x < 4.0; x *= 1.1) {
    const double expected = x <= a ? x : 1.0 - (1.0 - a) * std::exp(-(x - a) / (1.0 - a));
    EXPECT_NEAR(displayLight(photographic, x), expected, 2e-3) << x;
  }
}

TEST(PhotographicView, KeepsBlackAndMiddleGreyAndRollsOffBelowWhite) {
  EXPECT_EQ(shownGrey(photographic, 0.0f), 0.0f);
  EXPECT_NEAR(displayLight(photographic, 0.18), 0.18, 1e-3);
  EXPECT_GT(displayLight(photographic, 4.0), 0.97);
  EXPECT_LT(displayLight(photographic, 4.0), 0.995);
  EXPECT_EQ(std::lround(255.0f * shownGrey(photographic, 65504.0f)), 255);
}

TEST(PhotographicView, RisesStrictlyUpTo4AndNeverFalls) {
  float previous = 0.0f;
  for (double stops = -12.0; stops < 20.0; stops += 0.01) {
    const double x = 0.18 * std::exp2(stops);
    const float y = shownGrey(photographic, static_cast<float>(x));
    if (x < 4.0) {
      EXPECT_GT(y, previous) << x;
      EXPECT_LT(y, 1.0f) << x;
    } else {
      EXPECT_GE(y, previous - 1e-6f) << x;
    }
    previous = y;
  }
}

TEST(PhotographicView, KeepsDarkTissueAndTheOrderOfChannels) {
  const std::vector<float> dark = shown(photographic, 0.17f, 0.06f, 0.05f);
  EXPECT_NEAR(decodedSrgb(dark[0]), 0.17, 1e-3);
  EXPECT_NEAR(decodedSrgb(dark[1]), 0.06, 1e-3);
  EXPECT_NEAR(decodedSrgb(dark[2]), 0.05, 1e-3);
  for (const float exposure : {0.5f, 1.0f, 2.0f, 4.0f}) {
    const std::vector<float> muscle =
        shown(photographic, 0.55f * exposure, 0.18f * exposure, 0.14f * exposure);
    EXPECT_GT(muscle[0], muscle[1]);
    EXPECT_GT(muscle[1], muscle[2]);
  }
}

TEST(StandardView, IsTheSrgbEncodingWithClipping) {
  constexpr DisplayView view = DisplayView::standard;
  for (const double x : {0.0, 0.001, 0.01, 0.18, 0.5, 0.9, 1.0})
    EXPECT_NEAR(displayLight(view, x), x, 2e-5) << x;
  EXPECT_EQ(std::lround(65535.0f * shownGrey(view, 1.5f)), 65535);
  EXPECT_LE(shownGrey(view, 1.5f), 1.0f);
  EXPECT_EQ(shownGrey(view, -0.5f), 0.0f);
}

TEST(DisplayTransform, ShowsNanAsBlackAndInfinityAsWhite) {
  for (const DisplayView view : {photographic, DisplayView::standard}) {
    EXPECT_EQ(shownGrey(view, notANumber), 0.0f);
    EXPECT_EQ(shownGrey(view, -infinite), 0.0f);
    EXPECT_GT(shownGrey(view, infinite), 0.999f);
    EXPECT_GT(shownGrey(view, std::numeric_limits<float>::max()), 0.999f);
  }
}

TEST(DisplayTransform, HandlesEveryPixelAlike) {
  const float grey = shownGrey(photographic, 0.3f);
  std::vector<float> many;
  for (int i = 0; i < 1000; ++i)
    many.insert(many.end(), {0.3f, 0.3f, 0.3f, 1.0f});
  const std::vector<float> display = toDisplay(many, {photographic});
  for (std::size_t i = 0; i < display.size(); ++i)
    EXPECT_EQ(display[i], i % 4 == 3 ? 1.0f : grey);
  EXPECT_TRUE(toDisplay({}, {photographic}).empty());
}

TEST(DisplayTransform, IgnoresTheEnvironmentAndPrintsNothing) {
  ::setenv("OCIO", "/nowhere/config.ocio", 1);
  ::setenv("OCIO_ACTIVE_VIEWS", "Standard", 1);
  ::setenv("OCIO_ACTIVE_DISPLAYS", "Cinema", 1);
  ::testing::internal::CaptureStderr();
  const float shown = shownGrey(photographic, 1.0f);
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  EXPECT_LT(shown, 0.9f); // photographic: Standard would clip 1 to 1
  ::unsetenv("OCIO");
  ::unsetenv("OCIO_ACTIVE_VIEWS");
  ::unsetenv("OCIO_ACTIVE_DISPLAYS");
}

TEST(ToDisplay, ExposureMultipliesRadianceBeforeTheTone) {
  const std::vector<float> picture = {0.04f, 0.02f, 0.3f, 0.5f};
  std::vector<float> brighter = picture, darker = picture;
  for (std::size_t c = 0; c < 3; ++c) {
    brighter[c] *= 4.0f;
    darker[c] /= 8.0f;
  }
  EXPECT_EQ(toDisplay(picture, {photographic, 2.0}), toDisplay(brighter, {photographic}));
  EXPECT_EQ(toDisplay(picture, {photographic, -3.0}), toDisplay(darker, {photographic}));
  EXPECT_EQ(toDisplay(picture, {DisplayView::standard, 2.0}),
            toDisplay(picture, {DisplayView::standard}));
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

TEST(ToDisplay, TransparentIsBlackAndAlphaIsFrom0To1) {
  EXPECT_EQ(toDisplay({0.4f, 0.2f, 0.1f, 0.0f}, {photographic}),
            (std::vector<float>{0.0f, 0.0f, 0.0f, 0.0f}));
  EXPECT_EQ(toDisplay({0.4f, 0.2f, 0.1f, notANumber}, {photographic})[3], 0.0f);
  EXPECT_EQ(toDisplay({0.4f, 0.2f, 0.1f, 1.5f}, {photographic})[3], 1.0f);
}

} // namespace fenestra::DisplayTransformTests
