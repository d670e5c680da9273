// The grid on which labels were made, estimated from resampled label maps.

#include "files/segments/NativeGrid.h"

#include <gtest/gtest.h>

#include <functional>

namespace fenestra::core::NativeGridTests {
namespace {

using LabelAt = std::function<int(const Vec3&)>;

/// Labels on voxels of `spacing` mm in a cube of 90 mm, each that of the nearest native voxel. They
/// have two layers; the second is empty.
Vec3 estimate(const Vec3& spacing, const Vec3& native, const LabelAt& labelAt) {
  const Vec3 count = (90.0 * spacing.cwiseInverse()).array().round();
  const Size3 size = count.cast<std::int64_t>();
  LargeArray<std::int16_t> labels;
  for (std::int64_t z = 0; z < size.z(); ++z)
    for (std::int64_t y = 0; y < size.y(); ++y)
      for (std::int64_t x = 0; x < size.x(); ++x) {
        const Vec3 p = Size3(x, y, z).cast<double>().cwiseProduct(spacing) + 0.3 * native;
        const Vec3 voxel = p.cwiseQuotient(native).array().round();
        labels.push_back(static_cast<std::int16_t>(labelAt(voxel.cwiseProduct(native))));
        labels.push_back(0);
      }
  return estimateNativeVoxels(labels, size, 2).cwiseProduct(spacing);
}

/// Two overlapping balls, one within the other's box.
int labelBalls(const Vec3& p) {
  const double angle = 0.4 * std::sin(p.z() / 11.0);
  return (p - Vec3(44.0, 43.0, 45.0)).norm() < 38.0 - 4.0 * angle ? 700
         : (p - Vec3(60.0, 60.0, 50.0)).norm() < 25.0             ? 2
                                                                  : 0;
}

TEST(NativeGrid, IsFoundInLabelsResampledByNearestNeighbors) {
  const Vec3 ct(0.9355, 0.9355, 2.5);
  for (const double native : {1.5, 2.0, 3.0, 6.0}) {
    const Vec3 found = estimate(ct, Vec3::Constant(native), labelBalls);
    EXPECT_NEAR(found.x(), native, 0.08 * native) << native;
    EXPECT_NEAR(found.y(), native, 0.08 * native) << native;
    if (native < 2.5) {
      EXPECT_EQ(found.z(), 2.5) << "slices are thicker than native voxels";
    }
  }
}

TEST(NativeGrid, IsTheOwnGridOfOtherLabels) {
  const Vec3 spacing(1.0, 0.9, 1.2);
  EXPECT_EQ(estimate(spacing, spacing, labelBalls), spacing);
  EXPECT_EQ(estimate(spacing, spacing, [](const Vec3&) { return 0; }), spacing) << "no labels";
  EXPECT_EQ(estimate(spacing, spacing,
                     [](const Vec3& p) {
                       return (p - Vec3::Constant(40.0)).cwiseAbs().maxCoeff() < 30.0;
                     }),
            spacing)
      << "only two planes across each axis of a box have changes";
  EXPECT_EQ(
      estimate(spacing, spacing,
               [](const Vec3& p) { return (p - Vec3::Constant(40.0)).head<2>().norm() < 30.0; }),
      spacing)
      << "a cylinder does not change along its axis";
  EXPECT_EQ(estimate({9.0, 9.0, 9.0}, Vec3::Constant(9.0), labelBalls), Vec3::Constant(9.0))
      << "too few planes";
}

/// A segment that was made on a finer grid, such as bones by a threshold, joined with organs.
TEST(NativeGrid, OfLabelsFromTwoGridsIsTheFinerOne) {
  const auto isFine = [](const Vec3& p) { return (p - Vec3(45.0, 45.0, 45.0)).norm() < 42.0; };
  const auto coarsen = [](const Vec3& p) { return Vec3((p / 3.0).array().round() * 3.0); };
  const Vec3 spacing = Vec3::Ones();
  EXPECT_EQ(estimate(spacing, spacing,
                     [&](const Vec3& p) { return labelBalls(coarsen(p)) ? 1
                                                 : isFine(p)            ? 2
                                                                        : 0; }),
            spacing);
}

} // namespace
} // namespace fenestra::core::NativeGridTests
