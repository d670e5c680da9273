// Contours of drawn regions: loops, lengths, holes, and equally spaced control points.

#include "ClippingTesting.h"
#include "clip/focus/Contour.h"

#include <gtest/gtest.h>

#include <numeric>
#include <set>

namespace fenestra::core::ContourTests {
using namespace testing_clipping;

namespace {

double computeLength(const DepthBuffer& buffer, const Contour& contour) {
  double sum = 0.0;
  for (std::size_t i = 0; i < contour.size(); ++i)
    sum += (computeMidpoint(buffer, contour[(i + 1) % contour.size()]) -
            computeMidpoint(buffer, contour[i]))
               .norm();
  return sum;
}

std::vector<std::string> makeRandomPattern(Random& random, int width, int height, double density) {
  std::vector<std::string> rows(static_cast<std::size_t>(height));
  for (std::string& row : rows)
    for (int i = 0; i < width; ++i)
      row += random.uniform() < density ? '#' : '.';
  return rows;
}

/// Number of connected components of one kind of sample, with or without diagonal connections. A
/// border of dots is added to the pattern.
int countComponents(const std::vector<std::string>& rows, char kind, bool diagonal) {
  const int width = static_cast<int>(rows[0].size()) + 2,
            height = static_cast<int>(rows.size()) + 2;
  const auto at = [&](int x, int y) {
    const bool border = x == 0 || y == 0 || x == width - 1 || y == height - 1;
    return border ? '.' : rows[static_cast<std::size_t>(y - 1)][static_cast<std::size_t>(x - 1)];
  };
  std::set<std::pair<int, int>> visited;
  int count = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      if (at(x, y) != kind || visited.contains({x, y}))
        continue;
      ++count;
      std::vector<std::pair<int, int>> stack{{x, y}};
      visited.insert({x, y});
      while (!stack.empty()) {
        const auto [cx, cy] = stack.back();
        stack.pop_back();
        for (int dy = -1; dy <= 1; ++dy)
          for (int dx = -1; dx <= 1; ++dx) {
            const int nx = cx + dx, ny = cy + dy;
            if ((dx != 0 && dy != 0 && !diagonal) || nx < 0 || ny < 0 || nx >= width ||
                ny >= height)
              continue;
            if (at(nx, ny) == kind && visited.insert({nx, ny}).second)
              stack.push_back({nx, ny});
          }
      }
    }
  return count;
}

TEST(Contour, EmptyFocusHasNoContour) {
  EXPECT_TRUE(traceContours(makeFocusDepth({"...", "..."})).empty());
}

TEST(Contour, SingleSampleGivesADiamondShape) {
  const FocusDepth focus = makeFocusDepth({"...", ".#.", "..."});
  const auto contours = traceContours(focus);
  ASSERT_EQ(contours.size(), 1U);
  EXPECT_EQ(contours[0].size(), 4U);
  EXPECT_NEAR(computeLength(focus.depth, contours[0]), 2.0 * std::sqrt(2.0), 1e-12);
}

TEST(Contour, LengthOfARectangleFollowsFromItsSides) {
  const FocusDepth focus = makeFocusDepth({"......", ".####.", ".####.", ".####.", "......"});
  const auto contours = traceContours(focus);
  ASSERT_EQ(contours.size(), 1U);
  EXPECT_NEAR(computeLength(focus.depth, contours[0]), 2 * (3 + 2) + 4 * std::sqrt(0.5), 1e-12);
}

TEST(Contour, FocusAtTheEdgeOfTheBufferIsClosedThere) {
  const FocusDepth focus = makeFocusDepth({"###", "###"});
  const auto contours = traceContours(focus);
  ASSERT_EQ(contours.size(), 1U);
  EXPECT_EQ(contours[0].size(), 10U);
  EXPECT_NEAR(computeLength(focus.depth, contours[0]), 2 * (2 + 1) + 4 * std::sqrt(0.5), 1e-12);
}

TEST(Contour, HolesAndComponentsHaveSeparateLoops) {
  EXPECT_EQ(traceContours(makeFocusDepth({"###", "#.#", "###"})).size(), 2U);
  EXPECT_EQ(traceContours(makeFocusDepth({"#.#", "...", "#.#"})).size(), 4U);
  EXPECT_EQ(traceContours(makeFocusDepth({"#####", "#...#", "#.#.#", "#...#", "#####"})).size(),
            3U);
}

TEST(Contour, DiagonalNeighborsAreConnected) {
  EXPECT_EQ(traceContours(makeFocusDepth({"#.", ".#"})).size(), 1U);
  EXPECT_EQ(traceContours(makeFocusDepth({".#", "#."})).size(), 1U);
}

TEST(Contour, EveryCrossingLiesOnExactlyOneLoop) {
  Random random(1, 0, 0);
  for (int trial = 0; trial < 300; ++trial) {
    const auto pattern =
        makeRandomPattern(random, 2 + trial % 13, 2 + trial % 11, 0.1 + 0.08 * (trial % 10));
    const FocusDepth focus = makeFocusDepth(pattern);
    const auto contours = traceContours(focus);
    std::set<std::array<int, 3>> visited;
    for (const Contour& contour : contours)
      for (std::size_t i = 0; i < contour.size(); ++i) {
        const Crossing& c = contour[i];
        EXPECT_TRUE(focus.isFocus(c.column, c.row));
        EXPECT_TRUE(visited.insert({c.column, c.row, c.side}).second);
        const Crossing& next = contour[(i + 1) % contour.size()];
        EXPECT_LT((computeMidpoint(focus.depth, next) - computeMidpoint(focus.depth, c)).norm(),
                  1.0 + 1e-12);
      }
    std::size_t expected = 0;
    for (std::int64_t row = 0; row < focus.depth.rows(); ++row)
      for (std::int64_t column = 0; column < focus.depth.columns(); ++column)
        if (focus.isFocus(column, row))
          for (const auto& [dx, dy] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}})
            expected += focus.isFocus(column + dx, row + dy) ? 0 : 1;
    EXPECT_EQ(visited.size(), expected);
    const int loops =
        countComponents(pattern, '#', true) + countComponents(pattern, '.', false) - 1;
    EXPECT_EQ(contours.size(), static_cast<std::size_t>(loops));
  }
}

/// Disk around sample (50, 50) of radius 40 mm, with a hole of radius 15 mm, and a disk around
/// (115, 50) of radius 10 mm. Samples are 1 mm apart.
FocusDepth makeDisks() {
  std::vector<std::string> rows(100, std::string(140, '.'));
  for (std::size_t y = 0; y < rows.size(); ++y)
    for (std::size_t x = 0; x < rows[0].size(); ++x) {
      const double big = std::hypot(static_cast<double>(x) - 50.0, static_cast<double>(y) - 50.0);
      const double small =
          std::hypot(static_cast<double>(x) - 115.0, static_cast<double>(y) - 50.0);
      if ((big <= 40.0 && big > 15.0) || small <= 10.0)
        rows[y][x] = '#';
    }
  return makeFocusDepth(rows);
}

/// Column and row of a control point of makeDisks(): the center of its 140 x 100 samples is at the
/// origin, and y is up.
Vec2 toSample(const ControlPoint& point) {
  return {point.site.x() + 69.5, 49.5 - point.site.y()};
}

TEST(ControlPoints, AreDistributedOverLoopsInProportionToLength) {
  const FocusDepth focus = makeDisks();
  const auto contours = traceContours(focus);
  ASSERT_EQ(contours.size(), 3U);
  const auto points = placeControlPoints(focus, contours, 65);
  EXPECT_EQ(points.size(), 65U);
  std::array<int, 3> counts{};
  for (const ControlPoint& point : points) {
    const Vec2 sample = toSample(point);
    const double fromBig = (sample - Vec2(50, 50)).norm();
    ++counts[sample.x() > 100 ? 2U : fromBig > 27 ? 0U : 1U]; // small disk, outline, hole
  }
  EXPECT_NEAR(counts[0], 40, 1); // lengths are in proportion to the radii, 40 : 15 : 10
  EXPECT_NEAR(counts[1], 15, 1);
  EXPECT_NEAR(counts[2], 10, 1);
}

TEST(ControlPoints, AreUniformInArcLength) {
  std::vector<std::string> rows(100, std::string(100, '.'));
  for (std::size_t y = 0; y < 100; ++y)
    for (std::size_t x = 0; x < 100; ++x)
      if (std::hypot(static_cast<double>(x) - 50.0, static_cast<double>(y) - 50.0) <= 40.0)
        rows[y][x] = '#';
  const FocusDepth focus = makeFocusDepth(rows);
  const auto points = placeControlPoints(focus, traceContours(focus), 50);
  ASSERT_EQ(points.size(), 50U);
  std::vector<double> angles;
  for (const ControlPoint& point : points) // the disk's center is at (0.5, -0.5) mm
    angles.push_back(std::atan2(point.site.y() + 0.5, point.site.x() - 0.5));
  std::ranges::sort(angles);
  for (std::size_t i = 0; i < angles.size(); ++i) {
    const double gap =
        i + 1 < angles.size() ? angles[i + 1] - angles[i] : angles[0] + 2 * pi - angles[i];
    // Ideal: 5 mm. Sites are within one sample of their ideal position, and the contour, a
    // staircase, is up to 8 % longer than the circle between the axes and the diagonals.
    EXPECT_NEAR(gap * 40.0, 2 * pi * 40.0 / 50.0, 1.9);
  }
}

TEST(ControlPoints, HaveTheDepthOfTheirSampleAndUniqueSites) {
  const FocusDepth focus = makeDisks();
  const auto contours = traceContours(focus);
  const auto points = placeControlPoints(focus, contours, 1000);
  EXPECT_LT(points.size(), 1000U);
  std::set<std::pair<double, double>> sites;
  for (const ControlPoint& point : points) {
    EXPECT_TRUE(sites.insert({point.site.x(), point.site.y()}).second);
    const Vec2 sample = toSample(point);
    EXPECT_NEAR(point.depth, sample.x() + 10.0 * sample.y(), 1e-4); // as in makeFocusDepth()
  }
  EXPECT_LE(points.size(), findBoundarySamples(focus, contours).size());
}

TEST(ControlPoints, BoundarySamplesAreFocusSamplesWithAnOutsideNeighbor) {
  const FocusDepth focus = makeDisks();
  std::size_t expected = 0;
  for (std::int64_t row = 0; row < focus.depth.rows(); ++row)
    for (std::int64_t column = 0; column < focus.depth.columns(); ++column)
      if (focus.isFocus(column, row))
        expected += focus.isFocus(column + 1, row) && focus.isFocus(column - 1, row) &&
                            focus.isFocus(column, row + 1) && focus.isFocus(column, row - 1)
                        ? 0
                        : 1;
  EXPECT_EQ(findBoundarySamples(focus, traceContours(focus)).size(), expected);
}

} // namespace
} // namespace fenestra::core::ContourTests
