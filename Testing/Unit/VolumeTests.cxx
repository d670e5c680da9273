#include "model/volume/Field.h"

#include "Approx.h"
#include "base/Random.h"

#include <gtest/gtest.h>

namespace fenestra::core::testing::VolumeTests {
namespace {

Grid makeObliqueGrid(const Size3& size) {
  Affine map = Affine::Identity();
  map.linear() =
      (makeRotation(0.4, Vec3(1, 2, 3).normalized()).linear()) * Mat3::Diagonal({0.5, 2.0, -1.25});
  map.translation() = Vec3(10, -20, 30);
  return {size, map};
}

TEST(Grid, MapsBothWaysAndHasCorrectSpacing) {
  const Grid grid = makeObliqueGrid({5, 6, 7});
  EXPECT_TRUE(isApprox(grid.worldToIndex * (grid.indexToWorld * Vec3(1, 2, 3)), Vec3(1, 2, 3)));
  EXPECT_TRUE(isApprox(grid.spacing(), Vec3(0.5, 2.0, 1.25)));
  EXPECT_NEAR(grid.boundingRadius(), 0.5 * Vec3(2.5, 12, 8.75).norm(), 1e-12);
}

TEST(Field, ReproducesALinearFunctionAndItsGradient) {
  const Grid grid = makeObliqueGrid({6, 5, 4});
  const Vec3 slope(0.25, -1.5, 3.0);
  std::vector<float> voxels;
  for (int k = 0; k < 4; ++k)
    for (int j = 0; j < 5; ++j)
      for (int i = 0; i < 6; ++i)
        voxels.push_back(static_cast<float>(slope.dot(grid.indexToWorld * Vec3(i, j, k))));
  const Field<float> field(grid, voxels);
  Random random(1, 2, 3);
  for (int n = 0; n < 1000; ++n) {
    const Vec3 p(1.0 + 3.0 * random.uniform(), 1.0 + 2.0 * random.uniform(),
                 1.0 + random.uniform());
    ASSERT_NEAR(field.value(p), slope.dot(grid.indexToWorld * p), 1e-4);
    ASSERT_TRUE(isApprox(field.gradient(p), slope, 1e-4)) << field.gradient(p);
  }
}

TEST(Field, IsClampedInTheOuterHalfVoxelAndOnSingleSlices) {
  const std::vector<std::uint8_t> voxels = {10, 20, 30};
  const Field<std::uint8_t> row(Grid({3, 1, 1}, Affine::Identity()), voxels);
  EXPECT_EQ(row.value({-0.5, 0.3, -0.4}), 10.0);
  EXPECT_EQ(row.value({2.5, -0.5, 0.5}), 30.0);
  EXPECT_EQ(row.value({0.5, 0.0, 0.0}), 15.0);
  EXPECT_EQ(row.gradient({1.0, 0.0, 0.0}), Vec3(10, 0, 0));
}

TEST(Box, ClipsRaysParallelToFacesAndAxes) {
  const Box box{Vec3::Zero(), Vec3::Ones()};
  EXPECT_EQ(box.clip({{-1, 0.5, 0.5}, {1, 0, 0}}).begin, 1.0);
  EXPECT_EQ(box.clip({{-1, 0.5, 0.5}, {1, 0, 0}}).end, 2.0);
  EXPECT_FALSE(box.clip({{-1, 1.0, 0.5}, {1, 0, 0}}).isEmpty()) << "in a face";
  EXPECT_TRUE(box.clip({{-1, 1.5, 0.5}, {1, 0, 0}}).isEmpty());
  EXPECT_TRUE(box.clip({{2, 0.5, 0.5}, {1, 0, 0}}).isEmpty()) << "behind";
}

TEST(Frame, IsOrthonormalAndRightHanded) {
  Random random(4, 0, 0);
  for (int i = 0; i < 1000; ++i) {
    const Frame f(sampleUniformSphere(random.uniform2()));
    ASSERT_NEAR(f.tangent.dot(f.normal), 0.0, 1e-12);
    ASSERT_TRUE(isApprox(f.tangent.cross(f.bitangent), f.normal, 1e-12));
  }
  EXPECT_TRUE(allFinite(Frame(-Vec3::UnitZ()).tangent));
}

} // namespace
} // namespace fenestra::core::testing::VolumeTests
