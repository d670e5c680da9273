// Reflectance of a thick scattering medium. Statistical/ColorTests compares it with renders.

#include "Approx.h"
#include "Support.h"

#include "model/medium/Reflectance.h"

#include <gtest/gtest.h>

namespace fenestra::core::testing::ReflectanceTests {
namespace {

/// Reflectance of an isotropically scattering half-space, to 5e-5: 1 - sqrt(1 - a) H(1) with
/// Chandrasekhar's function H and albedo a.
TEST(Reflectance, MatchesChandrasekharForIsotropicScattering) {
  EXPECT_NEAR(toReflectance(0.5, 0.0), 0.1152, 0.01 * 0.1152);
  EXPECT_NEAR(toReflectance(0.9, 0.0), 0.4149, 0.01 * 0.4149);
  EXPECT_NEAR(toReflectance(0.99, 0.0), 0.7527, 0.01 * 0.7527);
}

TEST(Reflectance, MapsBlackToZeroAndWhiteToOne) {
  for (const double g : {-0.5, 0.0, 0.6, 0.95, 0.999}) {
    EXPECT_EQ(toReflectance(0.0, g), 0.0);
    EXPECT_NEAR(toReflectance(1.0, g), 1.0, 1e-12);
    EXPECT_EQ(toAlbedo(0.0, g), 0.0);
    EXPECT_EQ(toAlbedo(-1.0, g), 0.0);
    EXPECT_EQ(toAlbedo(1.0, g), toAlbedo(maxReflectance, g));
    EXPECT_LT(toAlbedo(1.0, g), 1.0);
  }
}

TEST(Reflectance, IsInverseOfAlbedo) {
  for (const double g : {0.0, 0.3, 0.5, 0.9, 0.95})
    for (double r = 0.01; r <= maxReflectance; r += 0.01) {
      EXPECT_NEAR(toReflectance(toAlbedo(r, g), g), r, 1e-9) << r << " " << g;
      EXPECT_GT(toAlbedo(r + 0.004, g), toAlbedo(r, g));
    }
}

/// Forward scattering penetrates deeper, so that the same albedo looks darker.
TEST(Reflectance, DecreasesWithG) {
  for (double a = 0.1; a < 1.0; a += 0.1)
    for (double g = 0.0; g < 0.9; g += 0.1)
      EXPECT_GT(toReflectance(a, g), toReflectance(a, g + 0.05)) << a << " " << g;
}

TEST(ReflectanceColors, AreLinearBetweenKnots) {
  const Rgb dark(0.1, 0.2, 0.05), light(0.9, 0.6, 0.95);
  for (const double g : {0.0, 0.5}) {
    const ColorFunction albedo =
        toAlbedo(ColorFunction({{10.0, dark}, {30.0, light}, {30.0, dark}, {40.0, dark}}), g);
    for (double s = 10.0; s < 30.0; s += 0.25) {
      const Rgb color = dark + (s - 10.0) / 20.0 * (light - dark);
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(toReflectance(albedo(s)[c], g), color[c],
                    (g > 0.0 ? 0.1 : 0.02) * color[c] + 0.003)
            << s;
    }
    EXPECT_TRUE(isApprox(albedo(30.0), toAlbedo(dark, g), 1e-12)) << "a step stays a step";
    EXPECT_TRUE(isApprox(albedo(50.0), toAlbedo(dark, g), 1e-12));
  }
}

} // namespace
} // namespace fenestra::core::testing::ReflectanceTests
