// Color differences compared with published pairs, and contrast of a focus with its surroundings.

#include "scene/Contrast.h"

#include "Support.h"
#include "base/Color.h"
#include "model/medium/Reflectance.h"

#include <gtest/gtest.h>

#include <numeric>

namespace fenestra::core::testing::ContrastTests {
namespace {

/// Sharma, Wu, Dalal 2005, table 1.
TEST(ColorVision, DeltaE2000OfPublishedPairs) {
  const auto expectPair = [](const Lab& x, const Lab& y, double expected) {
    EXPECT_NEAR(deltaE2000(x, y), expected, 5e-5);
    EXPECT_NEAR(deltaE2000(y, x), expected, 5e-5);
  };
  expectPair({50.0, 2.6772, -79.7751}, {50.0, 0.0, -82.7485}, 2.0425);
  expectPair({50.0, -1.3802, -84.2814}, {50.0, 0.0, -82.7485}, 1.0000);
  expectPair({50.0, 0.0, 0.0}, {50.0, -1.0, 2.0}, 2.3669);
  expectPair({50.0, 2.49, -0.001}, {50.0, -2.49, 0.0011}, 7.2195);
  expectPair({50.0, -0.001, 2.49}, {50.0, 0.0009, -2.49}, 4.8045);
  expectPair({50.0, 2.5, 0.0}, {73.0, 25.0, -18.0}, 27.1492);
  expectPair({50.0, 2.5, 0.0}, {58.0, 24.0, 15.0}, 19.4535);
  expectPair({60.2574, -34.0099, 36.2677}, {60.4626, -34.1751, 39.4387}, 1.2644);
  expectPair({63.0109, -31.0961, -5.8663}, {62.8187, -29.7946, -4.0864}, 1.2630);
  expectPair({22.7233, 20.0904, -46.694}, {23.0331, 14.973, -42.5619}, 2.0373);
  expectPair({2.0776, 0.0795, -1.135}, {0.9033, -0.0636, -0.5514}, 0.9082);
  expectPair({0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, 0.0);
}

TEST(ColorVision, LabOfPrimaries) {
  const Lab white = toLab(Rgb::Ones()), red = toLab(Rgb(1.0, 0.0, 0.0));
  EXPECT_NEAR(white.L, 100.0, 0.01);
  EXPECT_NEAR(std::hypot(white.a, white.b), 0.0, 0.02);
  EXPECT_NEAR(red.L, 53.24, 0.02);
  EXPECT_NEAR(red.a, 80.09, 0.05);
  EXPECT_NEAR(red.b, 67.20, 0.05);
  EXPECT_NEAR(toLab(Rgb::Constant(0.001)).L, 0.9033, 1e-3) << "on the linear segment near black";
  EXPECT_NEAR(deltaE76(white, red), 114.57, 0.1);
}

TEST(ColorVision, DichromatsSeeGraysUnchangedAndConfuseOneHue) {
  const Rgb red(0.5, 0.1, 0.1), olive(0.22, 0.2, 0.1), blue(0.1, 0.1, 0.5), teal(0.02, 0.18, 0.2);
  const auto difference = [](ColorVision vision, const Rgb& x, const Rgb& y) {
    return deltaE2000(toLab(simulateVision(vision, x)), toLab(simulateVision(vision, y)));
  };
  for (const ColorVision vision : colorVisions)
    for (const double level : {0.0, 0.2, 1.0})
      EXPECT_LT(deltaE76(toLab(simulateVision(vision, Rgb::Constant(level))),
                         toLab(Rgb::Constant(level))),
                0.01);
  EXPECT_LT(difference(ColorVision::deutan, red, olive),
            0.5 * difference(ColorVision::normal, red, olive));
  EXPECT_GT(difference(ColorVision::tritan, red, olive),
            difference(ColorVision::deutan, red, olive));
  EXPECT_LT(difference(ColorVision::tritan, blue, teal),
            0.6 * difference(ColorVision::normal, blue, teal));
}

constexpr double inside = 60.0, outside = 20.0, air = -1000.0;

/// Ball of radius 6 mm in another medium up to `radius`, then air.
Volume makeBallVolume(double radius) {
  return makeVolume<float>(makeCenteredGrid({40, 40, 40}, Vec3::Ones()),
                           [radius](const Vec3& index) {
                             const double distance = (index - Vec3::Constant(19.5)).norm();
                             return distance <= 6.0 ? inside : distance <= radius ? outside : air;
                           });
}

Mask makeBallMask() {
  const Grid grid = makeCenteredGrid({16, 16, 16}, Vec3::Ones());
  Mask mask{grid, {}, 0, {"ball"}};
  for (int z = 0; z < 16; ++z)
    for (int y = 0; y < 16; ++y)
      for (int x = 0; x < 16; ++x) {
        mask.voxels.push_back((grid.indexToWorld * Vec3(x, y, z)).norm() <= 6.0);
        mask.count += mask.voxels.back();
      }
  return mask;
}

/// Transparent air, and these albedos for the two media.
TransferFunction makeTransfer(const Rgb& context, const Rgb& focus) {
  return {ScalarFunction({makeKnot(-500.0, 0.0), makeKnot(0.0, 1.0)}),
          ColorFunction({{outside, context}, {inside, focus}})};
}

TEST(Contrast, SamplesScalarsOnBothSidesOfTheInterface) {
  const TransferFunction transfer = makeTransfer(Rgb(0.9, 0.5, 0.4), Rgb(0.9, 0.9, 0.9));
  const auto mean = [](const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  };
  const InterfaceScalars scalars = sampleInterface(makeBallMask(), makeBallVolume(8.0), transfer);
  EXPECT_EQ(mean(scalars.focus), inside);
  EXPECT_EQ(mean(scalars.context), outside) << "air beyond is not counted";
  EXPECT_TRUE(sampleInterface(makeBallMask(), makeBallVolume(6.0), transfer).context.empty())
      << "only air";
}

/// Surroundings as red as the focus differ from it by their saturation alone; they are not measured
/// where the focus has none.
TEST(Contrast, OfAFocusAndAContextOfSomeSaturation) {
  const Rgb red(0.9, 0.4, 0.35);
  const TransferFunction transfer = makeTransfer(red, red);
  const auto measure = [&](double saturation, double outerRadius) {
    return measureFocusContrast(saturation, makeBallMask(), makeBallVolume(outerRadius), transfer);
  };
  const FocusContrast equal = measure(1.0, 15.0), muted = measure(defaultContextSaturation, 15.0),
                      gray = measure(0.0, 15.0);
  EXPECT_EQ(equal.contrast->deltaE[0], 0.0);
  EXPECT_EQ(equal.contrast->deltaL, 0.0);
  EXPECT_EQ(muted.saturation, 0.75);
  EXPECT_GT(muted.contrast->deltaE[0], 3.0);
  EXPECT_GT(gray.contrast->deltaE[0], 20.0);
  // deltaE[0]: normal vision, deltaE[1]: red-blind (ColorVision).
  EXPECT_LT(gray.contrast->deltaE[1], gray.contrast->deltaE[0]);
  EXPECT_FALSE(measure(0.0, 6.0).contrast) << "only air around the focus";
}

} // namespace
} // namespace fenestra::core::testing::ContrastTests
