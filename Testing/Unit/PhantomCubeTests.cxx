#include "base/Error.h"
#include "phantoms/Phantoms.h"

#include "Approx.h"
#include <gtest/gtest.h>

namespace fenestra::core::PhantomCubeTests {
namespace {

const LargeArray<std::int16_t>& getVoxels(const Phantom& phantom) {
  return std::get<LargeArray<std::int16_t>>(phantom.volume.voxels);
}

std::vector<int> listSlices(const Phantom& cube) {
  const Size3& size = cube.volume.grid.size;
  std::vector<int> slices;
  for (std::int64_t k = 0; k < size.z(); ++k)
    slices.push_back(getVoxels(cube)[static_cast<std::size_t>(k * size.x() * size.y())]);
  return slices;
}

} // namespace

TEST(PhantomCube, PublishedCubeNumbersSlicesFromCenter) {
  const Phantom cube = makeCubePhantom();
  EXPECT_EQ(cube.volume.grid.size, Size3(512, 512, 512));
  const std::vector<int> slices = listSlices(cube);
  for (int k = 0; k < 512; ++k)
    EXPECT_EQ(slices[static_cast<std::size_t>(k)], k < 256 ? k - 255 : k - 256);
  EXPECT_EQ(cube.labels.size, Size3(255, 255, 391));
  EXPECT_EQ(cube.labels.offset, Size3(128, 128, 60));
  EXPECT_EQ(cube.volume.minimum, -255.0);
  EXPECT_EQ(cube.volume.maximum, 255.0);
}

TEST(PhantomCube, SmallCubePreservesRangeAndProportions) {
  const Phantom cube = makeCubePhantom({1.0, 24});
  const std::vector<int> slices = listSlices(cube);
  EXPECT_EQ(slices.front(), -255);
  EXPECT_EQ(slices.back(), 255);
  for (std::size_t k = 0; k < 24; ++k)
    EXPECT_EQ(slices[k], -slices[23 - k]);
  for (std::size_t i = 0; i < getVoxels(cube).size(); ++i)
    ASSERT_EQ(getVoxels(cube)[i], slices[i / 576]);
  EXPECT_EQ(cube.labels.size, Size3(12, 12, 18));
  EXPECT_EQ(cube.labels.offset, Size3(6, 6, 3));
  ASSERT_EQ(cube.labels.layers.size(), 1u);
  EXPECT_EQ(cube.labels.layers[0], std::vector<std::uint8_t>(12 * 12 * 18, 1));
}

TEST(PhantomCube, CubeIsCenteredAtOrigin) {
  for (const double edge : {1.0, 512.0}) {
    const Grid grid = makeCubePhantom({edge, 16}).volume.grid;
    EXPECT_TRUE(isApprox(grid.worldCorner(0), Vec3::Constant(-0.5 * edge)));
    EXPECT_TRUE(isApprox(grid.worldCorner(7), Vec3::Constant(0.5 * edge)));
  }
}

TEST(PhantomCube, OpacityAndColorDoNotDependOnEdge) {
  for (const double edge : {1.0, 512.0}) {
    const TransferFunction transfer = tabulate(makeCubePhantom({edge, 16}).property, "cube");
    EXPECT_NEAR(transfer.extinction(17.0).value() * edge, 100.0 * std::log(100.0), 1.0);
    const Rgb low = transfer.albedo(-255.0), high = transfer.albedo(255.0);
    EXPECT_GT(low.z(), 10.0 * low.x());
    EXPECT_GT(high.x(), 10.0 * high.z());
  }
}

TEST(PhantomCube, RefusesSizesAndEdgesOutOfRange) {
  EXPECT_THROW(makeCubePhantom({1.0, 15}), Error);
  EXPECT_THROW(makeCubePhantom({1.0, 1025}), Error);
  EXPECT_THROW(makeCubePhantom({0.0, 16}), Error);
  EXPECT_THROW(makeCubePhantom({-1.0, 16}), Error);
  EXPECT_THROW(makeCubePhantom({infinity, 16}), Error);
}

} // namespace fenestra::core::PhantomCubeTests
