#include "model/filtering/NoiseEstimate.h"

#include "NoisyVolumes.h"

#include <gtest/gtest.h>

namespace fenestra::core::testing::NoiseEstimateTests {
namespace {

const Grid slices = makeScaledGrid({60, 60, 20}, {0.9, 0.9, 2.5});

/// A body of two tissues, with bone, in air.
double body(const Size3& v) {
  const double r = std::hypot(static_cast<double>(v.x()) - 30.0, static_cast<double>(v.y()) - 30.0);
  return r < 5.0 ? 900.0 : r < 20.0 ? 55.0 : r < 26.0 ? -100.0 : -1000.0;
}

TEST(NoiseEstimate, FindsTheNoiseOfCt) {
  for (const double noise : {5.0, 20.0, 35.0}) {
    const Volume volume = makeVoxels<std::int16_t>(
        slices, [&](const Size3& v) { return body(v) + noise * normalNoise(1, v); });
    EXPECT_NEAR(estimateNoise(volume, Modality::ct), noise, 0.15 * noise);
  }
}

TEST(NoiseEstimate, FindsNoiseThatIsCorrelatedInTheSlice) {
  const auto blurred = [](const Size3& v) { // of unit variance
    double sum = 0.0;
    for (int k = 0; k < 9; ++k) {
      const Size3 step(k % 3 - 1, k / 3 - 1, 0);
      sum += (step.x() == 0 ? 2.0 : 1.0) * (step.y() == 0 ? 2.0 : 1.0) *
             normalNoise(2, v + step + Size3::Ones());
    }
    return sum / 6.0;
  };
  const Volume volume =
      makeVoxels<std::int16_t>(slices, [&](const Size3& v) { return body(v) + 30.0 * blurred(v); });
  const double estimate = estimateNoise(volume, Modality::ct);
  EXPECT_GT(estimate, 0.55 * 30.0);
  EXPECT_LT(estimate, 1.1 * 30.0);
}

TEST(NoiseEstimate, IsZeroWithoutNoise) {
  const Volume volume = makeVoxels<std::int16_t>(slices, body);
  EXPECT_EQ(estimateNoise(volume, Modality::ct), 0.0);
  EXPECT_EQ(estimateNoise(volume, Modality::mr), 0.0);
}

TEST(NoiseEstimate, FindsTheNoiseOfMrTissue) {
  const Volume volume =
      makeVoxels<std::uint8_t>(makeScaledGrid({40, 40, 40}, {1.0, 1.0, 1.0}), [](const Size3& v) {
        const double tissue = v.x() < 20 ? 0.0 : v.y() < 20 ? 90.0 : 150.0;
        return std::abs(tissue + 6.0 * normalNoise(3, v));
      });
  EXPECT_NEAR(estimateNoise(volume, Modality::mr), 1.2 * 6.0, 0.8);
}

TEST(NoiseEstimate, MeasuresSpeckleOnALogarithmicScale) {
  const auto speckle = [](double level) {
    return [level](const Size3& v) {
      return (v.x() < 20 ? 0.05 : 1.0) * level * std::exp(0.25 * normalNoise(4, v));
    };
  };
  const Grid grid = makeScaledGrid({40, 40, 40}, {1.0, 1.0, 1.0});
  for (const double level : {2000.0, 20000.0})
    EXPECT_NEAR(estimateNoise(makeVoxels<std::uint16_t>(grid, speckle(level)), Modality::us), 0.25,
                0.03);
}

TEST(NoiseEstimate, IsZeroForTooFewVoxels) {
  const auto noise = [](const Size3& v) { return 30.0 * normalNoise(5, v); };
  EXPECT_EQ(estimateNoise(makeVoxels<float>(makeScaledGrid({1, 1, 1}, Vec3::Ones()), noise),
                          Modality::ct),
            0.0);
  EXPECT_EQ(estimateNoise(makeVoxels<float>(makeScaledGrid({2, 300, 300}, Vec3(1, 1, 2)), noise),
                          Modality::mr),
            0.0);
  EXPECT_GT(estimateNoise(makeVoxels<float>(makeScaledGrid({100, 100, 1}, Vec3::Ones()), noise),
                          Modality::ct),
            20.0);
  const auto bone = [&](const Size3& v) { return 1000.0 + noise(v); };
  EXPECT_EQ(estimateNoise(makeVoxels<float>(slices, bone), Modality::ct), 0.0);
}

} // namespace
} // namespace fenestra::core::testing::NoiseEstimateTests
