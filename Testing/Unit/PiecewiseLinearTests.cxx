#include "model/medium/PiecewiseLinear.h"

#include "base/Random.h"

#include <gtest/gtest.h>

namespace fenestra::core::testing::PiecewiseLinearTests {
namespace {

using Knots = std::vector<ScalarFunction::Knot>;

ScalarFunction::Knot knot(double s, double y) {
  return {s, ScalarFunction::Value(y)};
}

/// Reference: the definition, by linear search.
double evalReference(const Knots& knots, double s) {
  if (s < knots.front().position)
    return knots.front().value.value();
  for (std::size_t i = knots.size() - 1; i > 0; --i)
    if (s >= knots[i].position) {
      if (i + 1 == knots.size())
        return knots[i].value.value();
      const double f = (s - knots[i].position) / (knots[i + 1].position - knots[i].position);
      return knots[i].value.value() + f * (knots[i + 1].value - knots[i].value).value();
    }
  const double f = (s - knots[0].position) / (knots[1].position - knots[0].position);
  return knots[0].value.value() + f * (knots[1].value - knots[0].value).value();
}

TEST(PiecewiseLinear, MatchesReferenceOnRandomKnots) {
  for (int trial = 0; trial < 200; ++trial) {
    Random random(1, static_cast<std::uint64_t>(trial), 0);
    Knots knots;
    double s = -10.0;
    const int count = 1 + static_cast<int>(random.uniform() * 40);
    for (int i = 0; i < count; ++i) {
      // Very uneven gaps, and some steps.
      s += random.uniform() < 0.2 ? 0.0 : std::pow(random.uniform(), 8.0) * 100.0;
      knots.push_back(knot(s, random.uniform()));
    }
    const ScalarFunction f(knots);
    for (int i = 0; i < 500 && count > 1; ++i) {
      const double x = i < count ? knots[static_cast<std::size_t>(i)].position
                                 : -12.0 + random.uniform() * (s + 14.0);
      ASSERT_NEAR(f(x).value(), evalReference(knots, x), 1e-12) << "at " << x;
    }
  }
}

TEST(PiecewiseLinear, RangeBoundsEveryValueOfInterval) {
  for (int trial = 0; trial < 200; ++trial) {
    Random random(2, static_cast<std::uint64_t>(trial), 0);
    Knots knots;
    for (int i = 0; i < 20; ++i)
      knots.push_back(knot(std::floor(random.uniform() * 30.0), random.uniform()));
    const ScalarFunction f(knots);
    const double low = random.uniform() * 30.0;
    const double high = low + random.uniform() * 5.0;
    const auto [least, greatest] = f.range(low, high);
    for (int i = 0; i <= 1000; ++i) {
      const double y = f(low + (high - low) * i / 1000.0).value();
      ASSERT_GE(y, least);
      ASSERT_LE(y, greatest);
    }
  }
}

TEST(PiecewiseLinear, StepHasValueOfRightSide) {
  const ScalarFunction f({knot(0, 0), knot(1, 0), knot(1, 5), knot(2, 5)});
  EXPECT_EQ(f(std::nextafter(1.0, 0.0)).value(), 0.0);
  EXPECT_EQ(f(1.0).value(), 5.0);
  EXPECT_EQ(f.range(0.5, 1.0)[1], 5.0);
  EXPECT_EQ(f.range(1.0, 1.5)[0], 0.0) << "includes both values of a step at its end";
}

TEST(PiecewiseLinear, SingleKnotIsConstantAlsoForNan) {
  const ScalarFunction f({knot(3, 7)});
  for (const double s : {-1e300, 3.0, 1e300, std::nan("")})
    EXPECT_EQ(f(s).value(), 7.0);
  EXPECT_EQ(f.span(), 0.0);
}

TEST(PiecewiseLinear, SortingIsStable) {
  const ScalarFunction f({knot(2, 1), knot(0, 0), knot(1, 3), knot(1, 4)});
  EXPECT_EQ(f.knots()[1].value.value(), 3.0);
  EXPECT_EQ(f.knots()[2].value.value(), 4.0);
}

} // namespace
} // namespace fenestra::core::testing::PiecewiseLinearTests
