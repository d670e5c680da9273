// Lines that stand for cells (CellLines.h), compared with their definition.

#include "model/masks/CellLines.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace fenestra::core::testing::CellLinesTests {
namespace {

using Rows = std::array<std::vector<std::uint8_t>, 4>;

/// Rows of a smoothed surface with random slopes, in which 0 and 255 come in runs.
Rows makeRows(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  const auto draw = [&](double least, double most) {
    return std::uniform_real_distribution<>(least, most)(random);
  };
  const double frequency = draw(0.02, 0.5), amplitude = draw(10.0, 1000.0);
  Rows rows;
  for (std::vector<std::uint8_t>& row : rows) {
    const double shift = draw(-0.5, 0.5), level = draw(60.0, 200.0);
    for (std::size_t x = 0; x < count; ++x)
      row.push_back(static_cast<std::uint8_t>(std::clamp(
          level + amplitude * std::sin(frequency * static_cast<double>(x) + shift), 0.0, 255.0)));
  }
  return rows;
}

/// Adds the lines of one cell; `cell`: x fastest, then y, then z.
void addCell(const std::array<int, 8>& cell, LevelLengths& lengths) {
  std::array<int, 3> changes{};
  for (std::size_t i = 0; i < 8; ++i)
    for (std::size_t axis = 0; axis < 3; ++axis)
      changes[axis] += (i >> axis & 1) != 0 ? cell[i] : -cell[i];
  const auto along = static_cast<std::size_t>(
      std::ranges::max_element(changes, {}, [](int change) { return std::abs(change); }) -
      changes.begin());
  const std::size_t step = 1 << along, a = 1 << (along + 1) % 3, b = 1 << (along + 2) % 3;
  constexpr double nearer = 0.7886751345948129; // Gauss, 2 points
  constexpr int one = LevelLengths::steps << 16;
  const int nearNear = static_cast<int>(nearer * nearer * one + 0.5),
            nearFar = static_cast<int>(nearer * (1.0 - nearer) * one + 0.5);
  const auto interpolate = [&](std::size_t corner) {
    return (nearNear * cell[corner] + nearFar * (cell[corner ^ a] + cell[corner ^ b]) +
            (one - nearNear - 2 * nearFar) * cell[corner ^ a ^ b] + (1 << 15)) >>
           16;
  };
  for (const std::size_t corner : {std::size_t{0}, a, b, a + b}) {
    const int begin = interpolate(corner), end = interpolate(corner + step);
    if (begin != end)
      lengths.addLine(std::min(begin, end), std::max(begin, end));
    else if (begin == LevelLengths::maxValue)
      lengths.addInside(LevelLengths::unit);
    else if (begin > 0)
      lengths.addLine(std::max(begin - LevelLengths::steps, 0),
                      std::min(begin + LevelLengths::steps, LevelLengths::maxValue));
  }
}

LevelLengths computeExpected(const Rows& rows, const VoxelValues& values) {
  LevelLengths lengths(LevelLengths::allLevels);
  for (std::size_t x = 0; x + 1 < rows[0].size(); ++x) {
    std::array<int, 8> cell{};
    for (std::size_t i = 0; i < 8; ++i)
      cell[i] = values[rows[i / 2][x + i % 2]];
    addCell(cell, lengths);
  }
  return lengths;
}

LevelLengths compute(const Rows& rows, const VoxelValues& values,
                     const LevelLengths::Levels& levels) {
  LevelLengths lengths(levels);
  addCellLines({rows[0].data(), rows[1].data(), rows[2].data(), rows[3].data()},
               static_cast<std::int64_t>(rows[0].size()), values, lengths);
  return lengths;
}

TEST(CellLines, LengthsEqualTheirDefinition) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    const Rows rows = makeRows(1 + seed * 7 % 400, seed);
    VoxelValues values;
    for (std::size_t i = 0; i < values.size(); ++i) // some with 0 or 255 for a range of voxels
      values[i] = static_cast<std::uint8_t>(
          255.0 * std::pow(static_cast<double>(i) / 255.0, 0.5 + 0.02 * seed));
    const LevelLengths expected = computeExpected(rows, values);
    const LevelLengths all = compute(rows, values, LevelLengths::allLevels);
    for (double level = 0.0; level < 255.0; level += 0.25)
      ASSERT_EQ(all.findLength(level), expected.findLength(level)) << seed << ' ' << level;
    const LevelLengths::Levels levels{static_cast<int>(4 * (seed % 130)), 520 + 4 * 40};
    const LevelLengths some = compute(rows, values, levels);
    for (int level = levels.first; level < levels.last; ++level)
      ASSERT_EQ(some.findLength(0.25 * level), expected.findLength(0.25 * level)) << seed;
  }
}

TEST(CellLines, LevelIsExactIfItIsInTheRange) {
  VoxelValues same;
  for (std::size_t i = 0; i < same.size(); ++i)
    same[i] = static_cast<std::uint8_t>(i);
  int found = 0;
  for (unsigned seed = 0; seed < 100; ++seed) {
    const Rows rows = makeRows(300, seed);
    const LevelLengths expected = computeExpected(rows, same);
    const LevelLengths some = compute(rows, same, {400, 600});
    for (const double level : {60.0, 99.0, 101.0, 127.5, 149.0, 151.0, 200.0}) {
      const auto length =
          static_cast<std::int64_t>(expected.findLength(level) * LevelLengths::unit);
      if (!some.hasLevel(length))
        continue;
      ++found;
      EXPECT_EQ(some.findLevel(length), expected.findLevel(length)) << seed;
    }
  }
  EXPECT_GT(found, 150);
}

} // namespace
} // namespace fenestra::core::testing::CellLinesTests
