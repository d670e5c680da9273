// Skin detected from the scalars, on bodies of water in air.

#include "model/masks/OuterLayer.h"

#include "ClippingTesting.h"
#include "model/volume/Field.h"

#include <gtest/gtest.h>

namespace fenestra::core::OuterLayerTests {
using namespace testing_clipping;

namespace {

constexpr double radius = 30.0, depth = 2.5; // mm
constexpr double airBelow = -300.0;          // HU

/// CT volume: water where isWater(world) is true, else air.
template <typename IsWater>
Volume makeCt(const Grid& grid, const IsWater& isWater) {
  LargeArray<std::int16_t> voxels;
  for (std::int64_t z = 0; z < grid.size.z(); ++z)
    for (std::int64_t y = 0; y < grid.size.y(); ++y)
      for (std::int64_t x = 0; x < grid.size.x(); ++x)
        voxels.push_back(isWater(grid.indexToWorld * Size3(x, y, z).cast<double>()) ? 0 : -1000);
  return {grid, std::move(voxels), -1000.0, 0.0, "ct", {}};
}

double evalMask(const Mask& mask, const Vec3& world) {
  return Field<std::uint8_t>(mask.grid, mask.voxels).value(mask.grid.worldToIndex * world) /
         mask.maxValue;
}

/// Grids of several spacings; the last one has rotated and mirrored axes.
std::vector<Grid> makeGrids() {
  std::vector<Grid> all = {makeCenteredGrid({81, 81, 81}, Vec3(1.0, 1.0, 1.0)),
                           makeCenteredGrid({121, 121, 41}, Vec3(0.7, 0.7, 2.2))};
  const Mat3 rotation = Mat3::FromRows(Vec3(0, 0, -1), Vec3(1, 0, 0), Vec3(0, 1, 0));
  all.push_back({{81, 81, 81}, Affine(rotation, -(rotation * Vec3::Constant(40.0)))});
  return all;
}

TEST(OuterLayer, HasRequestedDepth) {
  for (const Grid& grid : makeGrids()) {
    const Mask skin = findOuterLayer(makeCt(grid, [](const Vec3& p) { return p.norm() < radius; }),
                                     airBelow, depth);
    ASSERT_GT(skin.count, 0);
    for (const Vec3& direction :
         {Vec3(1, 0, 0), Vec3(0, -1, 0), Vec3(0.6, 0.64, 0.48), Vec3(0, 0, 1)}) {
      EXPECT_EQ(evalMask(skin, (radius + 2.0) * direction), 1.0) << direction.x();
      EXPECT_GT(evalMask(skin, (radius - 0.5) * direction), 0.7) << direction.x();
      EXPECT_LT(evalMask(skin, (radius - depth - 2.5) * direction), 0.2) << direction.x();
      EXPECT_EQ(evalMask(skin, 0.5 * radius * direction), 0.0);
    }
  }
}

/// Air inside the body does not count, even if the end of the scan cuts it open. Air in a fold that
/// opens to the side does.
TEST(OuterLayer, LiesAtSurroundingAir) {
  for (const Grid& grid : makeGrids()) {
    const auto isWater = [](const Vec3& p) {
      const bool isInLung = std::hypot(p.x() - 10.0, p.y()) < 6.0;
      const bool isInFold = p.x() < -10.0 && std::abs(p.y()) < 3.0;
      return std::hypot(p.x(), p.y()) < radius && !isInLung && !isInFold;
    };
    const Mask skin = findOuterLayer(makeCt(grid, isWater), airBelow, depth);
    EXPECT_EQ(evalMask(skin, Vec3(10, 0, 0)), 0.0);
    EXPECT_EQ(evalMask(skin, Vec3(10, 0, 39)), 0.0);
    EXPECT_EQ(evalMask(skin, Vec3(-15, 0, 0)), 1.0);
    EXPECT_GT(evalMask(skin, Vec3(-9.5, 0, 0)), 0.7);
  }
}

TEST(OuterLayer, IsEmptyWithoutAirOrBody) {
  const Grid grid = makeGrids().front();
  EXPECT_EQ(findOuterLayer(makeCt(grid, [](const Vec3&) { return true; }), airBelow, depth).count,
            0);
  EXPECT_EQ(findOuterLayer(makeCt(grid, [](const Vec3&) { return false; }), airBelow, depth).count,
            0);
  const auto inside = [](const Vec3& p) { return p.norm() > 5.0; };
  EXPECT_EQ(findOuterLayer(makeCt(grid, inside), airBelow, depth).count, 0) << "enclosed air";
}

TEST(OuterLayer, AcceptsVoxelsOfAnySize) {
  for (const double spacing : {1e-300, 1e-9, 1e-3, 50.0, 1e9, 1e300})
    for (const Size3& size : {Size3(1, 1, 1), Size3(9, 1, 4), Size3(9, 9, 9)}) {
      const Grid grid = makeCenteredGrid(size, Vec3(spacing, 1.0, spacing));
      const auto isWater = [&](const Vec3& p) { return p.x() > 0.0; };
      const Mask skin = findOuterLayer(makeCt(grid, isWater), airBelow, depth);
      EXPECT_LE(skin.voxels.size(), 729U);
    }
}

TEST(OuterLayer, ResamplesOnLatticeOfLabels) {
  const Grid volume = makeGrids().front();
  const Mask skin = findOuterLayer(makeCt(volume, [](const Vec3& p) { return p.norm() < radius; }),
                                   airBelow, depth);
  const Mat3 rotation = Mat3::FromRows(Vec3(0.8, -0.6, 0), Vec3(0.6, 0.8, 0), Vec3(0, 0, 1.7));
  const Grid labels({7, 5, 3}, Affine(rotation, Vec3(3, 4, 5)));
  const Mask onLabels = resampleMask(skin, labels, volume);
  const Vec3 origin = labels.worldToIndex * onLabels.grid.indexToWorld.translation();
  EXPECT_LT((origin - origin.array().round().matrix()).norm(), 1e-9);
  const Box box = onLabels.grid.indexBox();
  for (int i = 0; i < 8; ++i) {
    const Vec3 corner = onLabels.grid.worldToIndex * volume.worldCorner(i);
    EXPECT_EQ(corner.cwiseMax(box.lower).cwiseMin(box.upper), corner);
  }
  double greatest = 0.0;
  for (std::int64_t z = 0; z < onLabels.grid.size.z(); ++z)
    for (std::int64_t y = 0; y < onLabels.grid.size.y(); ++y)
      for (std::int64_t x = 0; x < onLabels.grid.size.x(); ++x) {
        const Size3 voxel(x, y, z);
        const double value = onLabels.voxels[linearIndex(voxel, onLabels.grid.size)] / 255.0;
        greatest = std::max(greatest, std::abs(value - evalMask(skin, onLabels.grid.indexToWorld *
                                                                          voxel.cast<double>())));
      }
  EXPECT_LT(greatest, 0.501 / 255.0);
  const Grid tiny({7, 5, 3}, Affine(0.01 * Mat3::Identity()));
  EXPECT_EQ(resampleMask(skin, tiny, volume).voxels, std::vector<std::uint8_t>{0}) << "too large";
}

} // namespace
} // namespace fenestra::core::OuterLayerTests
