#include "clip/mesh/FocusTriangles.h"

#include <gtest/gtest.h>

#include <map>
#include <utility>

namespace fenestra::core::FocusTrianglesTests {
namespace {

/// Mask of a ball of 8 voxels radius, smoothed: the indicator falls linearly over two voxels.
Mask makeBall(const Affine& indexToWorld) {
  Mask mask;
  mask.grid = Grid(Size3(21, 21, 21), indexToWorld);
  mask.maxValue = 255;
  for (std::int64_t i = 0; i < 21 * 21 * 21; ++i) {
    const Vec3 at(double(i % 21) - 10.0, double(i / 21 % 21) - 10.0, double(i / 441) - 10.0);
    const double inside = std::clamp(0.5 + 0.5 * (8.0 - at.norm()), 0.0, 1.0);
    mask.voxels.push_back(static_cast<std::uint8_t>(std::lround(255.0 * inside)));
  }
  return mask;
}

double findVolume(const SurfaceMesh& mesh) {
  double volume = 0.0;
  for (const auto& [a, b, c] : mesh.triangles)
    volume += mesh.points[a].dot(mesh.points[b].cross(mesh.points[c])) / 6.0;
  return volume;
}

/// A sheared grid of anisotropic voxels of 1.5 mm³, mirrored or not.
Affine makeAxes(double mirror) {
  Affine axes;
  const double rows[3][3] = {{0.5, 0.3, 0.0}, {0.0, 1.5, mirror * 0.2}, {0.0, 0.0, mirror * 2.0}};
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      axes.linear()(row, column) = rows[row][column];
  axes.translation() = Vec3(30, -20, 10);
  return axes;
}

class FocusTriangles : public ::testing::TestWithParam<double> {};

TEST_P(FocusTriangles, EncloseTheVolumeOfABall) {
  const Mask ball = makeBall(makeAxes(GetParam()));
  const SurfaceMesh mesh = triangulate(ball, ball.grid);
  const double expected = 4.0 / 3.0 * pi * 512.0 * 1.5;
  EXPECT_NEAR(findVolume(mesh), expected, 0.02 * expected); // above 0: seen from outside
  EXPECT_TRUE(mesh.depths.empty());
  for (const Vec3& point : mesh.points)
    EXPECT_NEAR((ball.grid.worldToIndex * point - Vec3::Constant(10.0)).norm(), 8.0, 0.1);
}

/// Each edge belongs to two triangles, which pass it in opposite directions.
TEST_P(FocusTriangles, AreClosed) {
  const Mask ball = makeBall(makeAxes(GetParam()));
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> sides;
  for (const auto& corners : triangulate(ball, ball.grid).triangles)
    for (std::size_t k = 0; k < 3; ++k)
      ++sides[{corners[k], corners[(k + 1) % 3]}];
  ASSERT_FALSE(sides.empty());
  for (const auto& [side, count] : sides) {
    EXPECT_EQ(count, 1);
    EXPECT_TRUE(sides.contains({side.second, side.first}));
  }
}

INSTANTIATE_TEST_SUITE_P(Grids, FocusTriangles, ::testing::Values(1.0, -1.0));

/// A mask that fills its grid ends at the faces of the volume.
TEST(FocusTrianglesOfABlock, StayInTheVolume) {
  Mask mask;
  mask.grid = Grid(Size3(4, 3, 2), makeAxes(1.0));
  mask.voxels.assign(24, 1);
  const SurfaceMesh mesh = triangulate(mask, mask.grid);
  const double box = 24.0 * 1.5;
  EXPECT_LE(findVolume(mesh), box);
  EXPECT_GT(findVolume(mesh), 0.7 * box); // without the edges of the box
  for (const Vec3& point : mesh.points) {
    const Vec3 index = mask.grid.worldToIndex * point;
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_GT(index[axis], -0.5 - 1e-9);
      EXPECT_LT(index[axis], double(mask.grid.size[axis]) - 0.5 + 1e-9);
    }
  }
}

TEST(FocusTrianglesOfNothing, AreNone) {
  Mask mask;
  mask.grid = Grid(Size3(2, 2, 2), makeAxes(1.0));
  mask.voxels.assign(8, 0);
  EXPECT_TRUE(triangulate(mask, mask.grid).triangles.empty());
}

} // namespace
} // namespace fenestra::core::FocusTrianglesTests
