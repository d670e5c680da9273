#include "clip/surface/KernelSums.h"

#include "ClippingTesting.h"
#include "base/SimdTargets.h"

#include <gtest/gtest.h>
#include <hwy/highway.h>

namespace fenestra::core::KernelSumsTests {
using namespace testing_clipping;

namespace {

constexpr std::size_t maxLength = 37;
constexpr double untouched = -7e77;

/// Calls check(row, sums) for rows of every length on every instruction set. `sums` has one
/// additional number at its end, which must stay `untouched`.
template <typename Check>
void forEachRow(Check&& check) {
  Random random(1, 0, 0);
  for (std::int64_t left = hwy::SupportedTargets() & HWY_TARGETS; left != 0; left &= left - 1) {
    SCOPED_TRACE(hwy::TargetName(left & -left));
    hwy::SetSupportedTargetsForTest(left & -left);
    for (std::size_t length = 0; length <= maxLength; ++length) {
      std::vector<double> row(length); // exact length: sanitizers detect reads beyond it
      for (double& x : row)
        x = uniform(random, -1, 1);
      std::vector<double> sums(length + 1, 0.25);
      sums.back() = untouched;
      check(row, sums);
      EXPECT_EQ(sums.back(), untouched) << length;
    }
    hwy::SetSupportedTargetsForTest(0); // all again
  }
}

double phi(double r2) {
  return r2 > 0.0 ? r2 * std::log(r2) : 0.0;
}

TEST(KernelSums, RowEqualsTheSumOfTerms) {
  Random random(2, 0, 0);
  std::vector<KernelTerm> terms;
  for (int i = 0; i < 9; ++i)
    terms.push_back({Vec2(uniform(random, -1, 1), uniform(random, -1, 1)), uniform(random, -2, 2)});
  forEachRow([&](std::vector<double>& row, std::vector<double>& sums) {
    constexpr double v = 0.125;
    if (row.size() > 4) { // one point at a site, one next to it
      row[3] = terms[0].site.x();
      row[4] = row[3] + 1e-160;
    }
    std::vector<KernelTerm> here = terms;
    here[0].site.y() = v;
    addKernels(here, row, v, std::span(sums).first(row.size()));
    for (std::size_t i = 0; i < row.size(); ++i) {
      double expected = 0.25;
      for (const KernelTerm& term : here)
        expected += term.weight * phi((Vec2(row[i], v) - term.site).squaredNorm());
      ASSERT_NEAR(sums[i], expected, 1e-13) << i << " of " << row.size();
    }
  });
}

TEST(KernelSums, PolynomialEqualsHornersScheme) {
  const std::vector<double> coefficients = {0.5, -1.0, 2.0, 0.25, -3.0};
  forEachRow([&](const std::vector<double>& row, std::vector<double>& sums) {
    constexpr double scale = 0.7;
    evaluatePolynomial(coefficients, scale, row, std::span(sums).first(row.size()));
    for (std::size_t i = 0; i < row.size(); ++i) {
      double expected = 0.0;
      for (std::size_t k = coefficients.size(); k-- > 0;)
        expected = expected * scale * row[i] + coefficients[k];
      ASSERT_NEAR(sums[i], expected, 1e-14) << i << " of " << row.size();
    }
  });
}

} // namespace
} // namespace fenestra::core::KernelSumsTests
