// Display views: properties of the tone curve, and alpha.

#include "base/Error.h"
#include "files/pictures/DisplayTransform.h"

#include <gtest/gtest.h>

#include <cstdlib>

namespace fenestra::DisplayTransformTests {
namespace {

constexpr float infinite = std::numeric_limits<float>::infinity();
constexpr float notANumber = std::numeric_limits<float>::quiet_NaN();

/// Inverse of the sRGB encoding (IEC 61966-2-1).
double decodedSrgb(double v) {
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

float shownGrey(const DisplayTransform& transform, float value) {
  float rgb[3] = {value, value, value};
  transform.apply(rgb, 1);
  EXPECT_EQ(rgb[0], rgb[1]);
  EXPECT_EQ(rgb[0], rgb[2]);
  return rgb[0];
}

double displayLight(const DisplayTransform& transform, double value) {
  return decodedSrgb(static_cast<double>(shownGrey(transform, static_cast<float>(value))));
}

Image onePixel(float r, float g, float b, float a) {
  return {1, 1, {{"R", {r}}, {"G", {g}}, {"B", {b}}, {"A", {a}}}, {}};
}

} // namespace

TEST(PhotographicView, FollowsItsFormula) {
  const DisplayTransform view;
  const double a = 0.18;
  for (double x = 0.001; x < 4.0; x *= 1.1) {
    const double expected = x <= a ? x : 1.0 - (1.0 - a) * std::exp(-(x - a) / (1.0 - a));
    EXPECT_NEAR(displayLight(view, x), expected, 2e-3) << x;
  }
}

TEST(PhotographicView, KeepsBlackAndMiddleGreyAndRollsOffBelowWhite) {
  const DisplayTransform view;
  EXPECT_EQ(shownGrey(view, 0.0f), 0.0f);
  EXPECT_NEAR(displayLight(view, 0.18), 0.18, 1e-3);
  EXPECT_GT(displayLight(view, 4.0), 0.97);
  EXPECT_LT(displayLight(view, 4.0), 0.995);
  EXPECT_EQ(std::lround(255.0f * shownGrey(view, 65504.0f)), 255);
}

TEST(PhotographicView, RisesStrictlyUpTo4AndNeverFalls) {
  const DisplayTransform view;
  float previous = 0.0f;
  for (double stops = -12.0; stops < 20.0; stops += 0.01) {
    const double x = 0.18 * std::exp2(stops);
    const float y = shownGrey(view, static_cast<float>(x));
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
  const DisplayTransform view;
  float dark[3] = {0.17f, 0.06f, 0.05f};
  view.apply(dark, 1);
  EXPECT_NEAR(decodedSrgb(dark[0]), 0.17, 1e-3);
  EXPECT_NEAR(decodedSrgb(dark[1]), 0.06, 1e-3);
  EXPECT_NEAR(decodedSrgb(dark[2]), 0.05, 1e-3);
  for (const float exposure : {0.5f, 1.0f, 2.0f, 4.0f}) {
    float muscle[3] = {0.55f * exposure, 0.18f * exposure, 0.14f * exposure};
    view.apply(muscle, 1);
    EXPECT_GT(muscle[0], muscle[1]);
    EXPECT_GT(muscle[1], muscle[2]);
  }
}

TEST(StandardView, IsTheSrgbEncodingWithClipping) {
  const DisplayTransform view("Standard");
  for (const double x : {0.0, 0.001, 0.01, 0.18, 0.5, 0.9, 1.0})
    EXPECT_NEAR(displayLight(view, x), x, 2e-5) << x;
  EXPECT_EQ(std::lround(65535.0f * shownGrey(view, 1.5f)), 65535);
  EXPECT_LE(shownGrey(view, 1.5f), 1.0f);
  EXPECT_EQ(shownGrey(view, -0.5f), 0.0f);
}

TEST(DisplayTransform, ShowsNanAsBlackAndInfinityAsWhite) {
  for (const char* name : {"Photographic", "Standard"}) {
    const DisplayTransform view(name);
    EXPECT_EQ(shownGrey(view, notANumber), 0.0f);
    EXPECT_EQ(shownGrey(view, -infinite), 0.0f);
    EXPECT_GT(shownGrey(view, infinite), 0.999f);
    EXPECT_GT(shownGrey(view, std::numeric_limits<float>::max()), 0.999f);
  }
}

TEST(DisplayTransform, HandlesEveryPixelAlike) {
  const DisplayTransform view;
  std::vector<float> many(3 * 1000, 0.3f);
  view.apply(many.data(), 1000);
  for (const float value : many)
    EXPECT_EQ(value, shownGrey(view, 0.3f));
  view.apply(nullptr, 0);
}

TEST(DisplayTransform, RefusesAnUnknownViewAndListsTheKnown) {
  try {
    DisplayTransform("Noir");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::usage);
    EXPECT_STREQ(error.what(),
                 "display view Noir: is unknown; choose one of Photographic, Standard");
  }
}

TEST(DisplayTransform, IgnoresTheEnvironmentAndPrintsNothing) {
  ::setenv("OCIO", "/nowhere/config.ocio", 1);
  ::setenv("OCIO_ACTIVE_VIEWS", "Standard", 1);
  ::setenv("OCIO_ACTIVE_DISPLAYS", "Cinema", 1);
  ::testing::internal::CaptureStderr();
  const float shown = shownGrey(DisplayTransform(), 1.0f);
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  EXPECT_LT(shown, 0.9f); // photographic: Standard would clip 1 to 1
  ::unsetenv("OCIO");
  ::unsetenv("OCIO_ACTIVE_VIEWS");
  ::unsetenv("OCIO_ACTIVE_DISPLAYS");
}

TEST(ToDisplay, DividesByAlphaBeforeTheView) {
  const DisplayTransform view;
  const auto half = toDisplay(onePixel(0.4f, 0.2f, 0.1f, 0.5f), view);
  const auto full = toDisplay(onePixel(0.8f, 0.4f, 0.2f, 1.0f), view);
  for (std::size_t c = 0; c < 3; ++c)
    EXPECT_FLOAT_EQ(half[c], full[c]);
  EXPECT_EQ(half[3], 0.5f);
  EXPECT_EQ(full[3], 1.0f);
}

TEST(ToDisplay, TransparentIsBlackAndMissingAlphaIsOpaque) {
  const DisplayTransform view;
  EXPECT_EQ(toDisplay(onePixel(0.4f, 0.2f, 0.1f, 0.0f), view),
            (std::vector<float>{0.0f, 0.0f, 0.0f, 0.0f}));
  EXPECT_EQ(toDisplay(onePixel(0.4f, 0.2f, 0.1f, notANumber), view)[3], 0.0f);
  EXPECT_EQ(toDisplay(onePixel(0.4f, 0.2f, 0.1f, 1.5f), view)[3], 1.0f);
  Image opaque = onePixel(0.4f, 0.2f, 0.1f, 0.0f);
  opaque.channels.erase("A");
  EXPECT_EQ(toDisplay(opaque, view)[3], 1.0f);
}

} // namespace fenestra::DisplayTransformTests
