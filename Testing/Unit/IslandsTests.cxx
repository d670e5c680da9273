#include "model/filtering/Islands.h"

#include "NoisyVolumes.h"

#include <gtest/gtest.h>

namespace fenestra::core::testing::IslandsTests {
namespace {

/// Islands of less than `most` voxels by flood fill: the volume with their voxels lowered.
struct FloodFill {
  LargeArray<std::int16_t> voxels;
  std::int64_t count = 0;

  FloodFill(const Volume& volume, std::int16_t level, std::size_t most)
      : voxels(voxelsOf<std::int16_t>(volume)) {
    const Size3& size = volume.grid.size;
    std::vector<bool> isVisited(voxels.size(), false);
    for (std::size_t start = 0; start < voxels.size(); ++start) {
      std::vector<std::size_t> group;
      const auto enter = [&](std::size_t i) {
        if (isVisited[i] || voxelsOf<std::int16_t>(volume)[i] <= level)
          return;
        isVisited[i] = true;
        group.push_back(i);
      };
      enter(start);
      for (std::size_t n = 0; n < group.size(); ++n)
        for (int k = 0; k < 27; ++k) {
          const auto i = static_cast<std::int64_t>(group[n]);
          const Size3 at(i % size.x() + k % 3 - 1, i / size.x() % size.y() + k / 3 % 3 - 1,
                         i / size.x() / size.y() + k / 9 - 1);
          if ((at.array() >= 0).all() && (at.array() < size.array()).all())
            enter(linearIndex(at, size));
        }
      if (group.empty() || group.size() >= most)
        continue;
      ++count;
      for (const std::size_t i : group)
        voxels[i] = level;
    }
  }
};

TEST(Islands, EqualThoseOfAFloodFill) {
  for (const double share : {0.02, 0.07, 0.12}) {
    const Volume volume = makeVoxels<std::int16_t>(
        makeScaledGrid({23, 17, 11}, {1.0, 1.0, 1.0}),
        [&](const Size3& v) { // the last slice is the greatest group
          return v.z() == 10 || std::abs(normalNoise(1, v)) < 1.25 * share ? 300.0 : 20.0;
        });
    const FloodFill expected(volume, 130, 12);
    const Islands islands = findIslands(volume, 130.0, 12.0);
    EXPECT_EQ(islands.count, expected.count);
    Volume lowered = volume;
    removeIslands(lowered, islands, 130.0);
    EXPECT_EQ(voxelsOf<std::int16_t>(lowered), expected.voxels) << share;
  }
}

TEST(Islands, AreSmallerThanAVolumeInCubicMillimeters) {
  const auto blocks = [](const Size3& v) { // of 8, 27 and 100 voxels
    const bool isSmall = (v.array() >= 1).all() && (v.array() <= 2).all();
    const bool isLarge = (v.array() >= 5).all() && (v.array() <= 7).all();
    return isSmall || isLarge || v.x() == 9 ? 500.0 : 0.0;
  };
  Volume volume = makeVoxels<float>(makeScaledGrid({10, 10, 10}, {2.0, 2.0, 5.0}), blocks);
  const auto count = [&](double largest) { return findIslands(volume, 100.0, largest).count; };
  EXPECT_EQ(count(159.0), 0);
  EXPECT_EQ(count(161.0), 1);
  EXPECT_EQ(count(541.0), 2);
  EXPECT_EQ(count(1e9), 2) << "not the greatest";
  EXPECT_NEAR(findIslands(volume, 100.0, 541.0).volume, 700.0, 1e-9);
  EXPECT_EQ(findIslands(volume, 500.0, 541.0).count, 0); // not above the onset
  removeIslands(volume, findIslands(volume, 100.5, 541.0), 100.5);
  const auto& voxels = std::get<LargeArray<float>>(volume.voxels);
  EXPECT_EQ(std::ranges::count(voxels, 500.0F), 100);
  EXPECT_EQ(std::ranges::count(voxels, 100.5F), 8 + 27);
}

/// A block of 2 x 2 x 2 voxels and one of 3 x 1 x 1: the first is preserved as a whole.
TEST(Islands, WithAPreservedRunRemainWhole) {
  Volume volume =
      makeVoxels<std::int16_t>(makeScaledGrid({10, 6, 6}, Vec3::Ones()), [](const Size3& v) {
        const bool isBlock = (v.array() >= 1).all() && (v.array() <= 2).all();
        const bool isRow = v.x() >= 5 && v.x() <= 7 && v.y() == 1 && v.z() == 1;
        return isBlock || isRow || v.z() == 5 ? 300.0 : 0.0;
      });
  const auto voxel = static_cast<std::int64_t>(linearIndex({2, 2, 2}, volume.grid.size));
  const Islands islands = findIslands(volume, 100.0, 9.0, [=](const RunOfIsland& run) {
    return run.begin <= voxel && voxel < run.end;
  });
  EXPECT_EQ(islands.count, 1);
  EXPECT_EQ(islands.volume, 3.0);
  removeIslands(volume, islands, 100.0);
  EXPECT_EQ(std::ranges::count(voxelsOf<std::int16_t>(volume), 300), 60 + 8);
}

TEST(Islands, OfIntegersAreLoweredToTransparentValues) {
  Volume volume =
      makeVoxels<std::int16_t>(makeScaledGrid({3, 3, 6}, Vec3::Ones()), [](const Size3& v) {
        return v.z() == 5 || (v.z() < 3 && v.sum() == 3) ? 9.0 : -7.0;
      });
  removeIslands(volume, findIslands(volume, -0.5, 400.0), -0.5);
  const auto& voxels = std::get<LargeArray<std::int16_t>>(volume.voxels);
  EXPECT_EQ(std::ranges::count(voxels, 9), 9);
  EXPECT_EQ(std::ranges::count(voxels, -1), 7);
}

} // namespace
} // namespace fenestra::core::testing::IslandsTests
