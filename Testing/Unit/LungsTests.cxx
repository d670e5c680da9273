// Lungs of a synthetic chest, found without labels.

#include "model/filtering/Lungs.h"

#include "SyntheticChest.h"

#include <gtest/gtest.h>

namespace fenestra::core::LungsTests {
namespace {

/// Fraction of the cells in a region that are lung.
template <typename Region>
double findFraction(const Lungs& lungs, const Region& isInside) {
  const Size3& size = lungs.grid.size;
  double inside = 0.0, marked = 0.0;
  for (std::int64_t z = 0; z < size.z(); ++z)
    for (std::int64_t y = 0; y < size.y(); ++y)
      for (std::int64_t x = 0; x < size.x(); ++x)
        if (const Size3 cell(x, y, z);
            isInside(lungs.grid.indexToWorld * Vec3(cell.cast<double>()))) {
          inside += 1.0;
          marked += lungs.marks[linearIndex(cell, size)];
        }
  return marked / inside;
}

bool isOutside(const Vec3& p) {
  return !SyntheticChest::isEllipsoid({p.x(), p.y(), 0.0}, Vec3::Zero(), {160, 100, 1});
}

TEST(Lungs, ContainTheirVesselsButNeitherBowelNorOutsideAir) {
  const std::optional<Lungs> lungs = findLungs(SyntheticChest().volume());
  ASSERT_TRUE(lungs);
  EXPECT_GT(findFraction(*lungs, SyntheticChest::isLung), 0.97);
  EXPECT_GT(findFraction(*lungs, SyntheticChest::isVessel), 0.95);
  EXPECT_EQ(findFraction(*lungs, isOutside), 0.0);
  EXPECT_EQ(findFraction(*lungs, [](const Vec3& p) { return p.z() < -70.0; }), 0.0);
  EXPECT_NEAR(lungs->volume, 2.0 * 4.0 / 3.0 * pi * 50.0 * 60.0 * 80.0, 0.05 * 2.0e6);
}

/// Axes of a sagittal scan: the end of the patient is another face of the volume.
TEST(Lungs, AreFoundInAnyOrderOfAxes) {
  const Volume axial = SyntheticChest().volume();
  const Size3& size = axial.grid.size;
  Volume sagittal = axial;
  const auto& from = std::get<LargeArray<std::int16_t>>(axial.voxels);
  auto& to = std::get<LargeArray<std::int16_t>>(sagittal.voxels);
  std::size_t next = 0;
  for (std::int64_t x = 0; x < size.x(); ++x)
    for (std::int64_t z = 0; z < size.z(); ++z)
      for (std::int64_t y = 0; y < size.y(); ++y)
        to[next++] = from[linearIndex({x, y, z}, size)];
  Mat3 axes;
  axes.col(0) = axial.grid.indexToWorld.linear().col(1);
  axes.col(1) = axial.grid.indexToWorld.linear().col(2);
  axes.col(2) = axial.grid.indexToWorld.linear().col(0);
  sagittal.grid = {{size.y(), size.z(), size.x()},
                   Affine(axes, axial.grid.indexToWorld.translation())};
  const std::optional<Lungs> lungs = findLungs(sagittal);
  ASSERT_TRUE(lungs);
  EXPECT_GT(findFraction(*lungs, SyntheticChest::isLung), 0.97);
}

TEST(Lungs, AreNotFoundInOtherAir) {
  EXPECT_FALSE(findLungs(SyntheticChest{.hasLungs = false}.volume()));
}

TEST(Lungs, AreNotFoundInAVolumeOfOneVoxel) {
  Volume volume;
  volume.grid = Grid(Size3::Constant(1), Affine::Identity());
  volume.voxels = LargeArray<std::int16_t>(1, -850);
  EXPECT_FALSE(findLungs(volume));
}

} // namespace
} // namespace fenestra::core::LungsTests
