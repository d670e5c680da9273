#include "integrator/simd/PiecewiseLinear.h"

#include "base/Narrow.h"
#include "base/Random.h"

#include <gtest/gtest.h>

namespace fenestra::core::testing::SimdLinesTests {
namespace {

ScalarFunction makeFunction(const std::vector<std::array<double, 2>>& points) {
  std::vector<ScalarFunction::Knot> knots;
  for (const auto& [position, value] : points)
    knots.push_back({position, ScalarFunction::Value(value)});
  return ScalarFunction(knots);
}

SimdLines makeLines(const std::vector<std::array<double, 2>>& points) {
  const ScalarFunction function = makeFunction(points);
  return SimdLines({&function});
}

/// Line segment that SIMD code finds for a scalar (Medium-inl.h), and its value there.
struct Lookup {
  bool isLine;
  double value;
};
Lookup lookUp(const SimdLines& table, double scalar) {
  const float at = (narrow(scalar) - table.start) * table.binsPerUnit;
  const float bin = std::max(std::min(at, table.last), 0.0F);
  const SimdTable::Line& line = table.lines[static_cast<std::size_t>(bin)];
  return {!std::isnan(line.slope),
          static_cast<double>(line.value + (bin - std::floor(bin)) * line.slope)};
}

/// Expects the lines to equal the function, and only bins around knots to have no line.
void expectFunction(const ScalarFunction& function, double tolerance) {
  const SimdLines table({&function});
  const double start = function.knots().front().position;
  const double margin = std::max(function.span(), 1e-30);
  for (int i = 0; i < 100000; ++i) {
    Random random(4, static_cast<std::uint64_t>(i), 0);
    const double s = start + margin * (1.4 * random.uniform() - 0.2);
    const Lookup at = lookUp(table, s);
    if (at.isLine) {
      ASSERT_NEAR(at.value, function(static_cast<double>(narrow(s))).value(), tolerance)
          << "at " << s;
    }
  }
  const auto withoutLine = std::ranges::count_if(
      table.lines, [](const SimdTable::Line& line) { return std::isnan(line.slope); });
  EXPECT_LE(withoutLine, 3 * static_cast<std::ptrdiff_t>(function.knots().size()));
}

TEST(SimdLines, EqualTheFunction) {
  expectFunction(makeFunction({{-1000, 0}, {-300.3, 0}, {45, 0.7}, {45.5, 2.5}, {3071, 9}}), 1e-3);
  expectFunction(makeFunction({{0, 0}, {255, 3}}), 1e-5);
  expectFunction(makeFunction({{0, 0}, {100, 0}, {100, 5}, {101, 5}, {101, 0}, {1000, 0.1}}), 1e-3);
}

TEST(SimdLines, BinsWithKnotsHaveNoLine) {
  const SimdLines table = makeLines({{0, 0}, {100.05, 1}, {1024, 0}});
  EXPECT_FALSE(lookUp(table, 100.5).isLine);
  EXPECT_TRUE(lookUp(table, 99.5).isLine);
  EXPECT_TRUE(lookUp(table, 101.5).isLine);
  const SimdLines jump = makeLines({{0, 0}, {512, 0}, {512, 1}, {1024, 1}});
  EXPECT_FALSE(lookUp(jump, 511.9).isLine) << "a scalar may be rounded to the other side";
  EXPECT_FALSE(lookUp(jump, 512.1).isLine);
}

TEST(SimdLines, DegenerateFunctionsAreSupported) {
  const SimdLines one = makeLines({{5, 2}});
  EXPECT_EQ(lookUp(one, -1e30).value, 2.0);
  EXPECT_EQ(lookUp(one, 1e30).value, 2.0);
  EXPECT_FALSE(lookUp(makeLines({{5, 2}, {5, 3}}), 4.0).isLine);
  EXPECT_FALSE(lookUp(makeLines({{0, 1}, {1e-44, 3}}), 1.0).isLine);
  // The span is a few ulps of float, so the bin of a scalar is ambiguous.
  EXPECT_FALSE(lookUp(makeLines({{1e6, 1}, {1e6 + 1.0, 3}}), 1e6).isLine);
}

} // namespace
} // namespace fenestra::core::testing::SimdLinesTests
