#include "model/medium/PackedMask.h"

#include "base/Random.h"

#include <gtest/gtest.h>

#include <numeric>

namespace fenestra::core::PackedMaskTests {
namespace {

/// Mask with rows of zeros, of one value, of distinct values, and of runs of 1 to 300 voxels.
Mask makeRows(std::int64_t columns) {
  Mask mask;
  mask.maxValue = 255;
  mask.grid = Grid(Size3(columns, 4, 3), Affine::Identity());
  Random random(3, static_cast<std::uint64_t>(columns), 0);
  const auto randomInt = [&](double most) {
    return static_cast<std::size_t>(random.uniform() * most);
  };
  for (std::int64_t row = 0; row < 12; ++row) {
    std::vector<std::uint8_t> voxels(static_cast<std::size_t>(columns), row % 4 == 1 ? 200 : 0);
    if (row % 4 == 2)
      std::iota(voxels.begin(), voxels.end(), std::uint8_t{1});
    for (std::size_t x = 0; row % 4 == 3 && x < voxels.size();) {
      const std::size_t length = randomInt(2.0) == 0 ? 1 + randomInt(4.0) : 1 + randomInt(300.0);
      const auto value = static_cast<std::uint8_t>(randomInt(256.0));
      for (const std::size_t end = std::min(x + length, voxels.size()); x < end; ++x)
        voxels[x] = value;
    }
    mask.voxels.insert(mask.voxels.end(), voxels.begin(), voxels.end());
  }
  return mask;
}

TEST(PackedMask, UnpacksEveryRow) {
  for (const std::int64_t columns : {1, 2, 3, 127, 128, 129, 130, 255, 256, 257, 1000}) {
    const Mask mask = makeRows(columns);
    const PackedMask packed(mask);
    EXPECT_EQ(packed.maxValue(), 255);
    std::size_t first = 0;
    for (std::int64_t z = 0; z < 3; ++z)
      for (std::int64_t y = 0; y < 4; ++y, first += static_cast<std::size_t>(columns)) {
        std::vector<std::uint8_t> row(static_cast<std::size_t>(columns) + 1, 77);
        const bool isWritten = packed.unpackRow(y, z, row.data());
        EXPECT_EQ(isWritten, mask.voxels[first] != 0 || y == 3) << "row " << y;
        EXPECT_EQ(row.back(), 77) << "beyond the row";
        row.pop_back();
        if (isWritten)
          EXPECT_TRUE(std::equal(row.begin(), row.end(),
                                 mask.voxels.begin() + std::ssize(row) * (y + 4 * z)))
              << columns << " columns, row " << y << ", slice " << z;
        else
          EXPECT_EQ(row.front(), 77) << "not written";
      }
  }
}

} // namespace
} // namespace fenestra::core::PackedMaskTests
