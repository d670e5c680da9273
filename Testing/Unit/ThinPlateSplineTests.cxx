// The spline, solved in the unit disk, equals the spline solved in mm.

#include "ClippingTesting.h"
#include "RunSettings.h"
#include "SaddleSpline.h"
#include "SplineCondition.h"
#include "clip/surface/ThinPlateSpline.h"

#include <gtest/gtest.h>

namespace fenestra::core::ThinPlateSplineTests {
using namespace testing_clipping;

namespace {

struct Data {
  std::vector<Vec2> sites;
  std::vector<double> values;

  ThinPlateSpline spline(double smoothing) const { return {sites, values, smoothing}; }
};

/// Sites on a wavy closed curve around (120, -300) mm with a mean radius of about `radius` mm.
Data makeOutline(int count, double radius) {
  Data data;
  for (int i = 0; i < count; ++i) {
    const double angle = 2.0 * pi * i / count;
    const double r = radius * (1.0 + 0.3 * std::cos(3.0 * angle));
    data.sites.push_back(Vec2(120.0, -300.0) + r * Vec2(std::cos(angle), std::sin(angle)));
    data.values.push_back(500.0 + 10.0 * std::sin(2.0 * angle) + 0.1 * r);
  }
  return data;
}

Data makeScattered(Random& random, int count, double radius) {
  Data data;
  while (static_cast<int>(data.sites.size()) < count) {
    const Vec2 site = randomPoint(random, -radius, radius).head<2>();
    if (site.norm() <= radius) {
      data.sites.push_back(site);
      data.values.push_back(uniform(random, -20, 20));
    }
  }
  return data;
}

TEST(ThinPlateSpline, EqualsTheSolutionOfTheSaddleSystem) {
  Random random(1, 0, 0);
  for (const double radius : {0.5, 8.0, 100.0})
    for (const double smoothing : {0.1, 0.5, 0.9, 1.0})
      for (const Data& data : {makeOutline(50, radius), makeScattered(random, 20, radius)}) {
        const ThinPlateSpline spline = data.spline(smoothing);
        const SaddleSpline<long double> reference(data.sites, data.values, smoothing);
        for (int i = 0; i < 50; ++i) {
          const Vec2 x = data.sites[0] + 3.0 * radius * randomPoint(random, -1, 1).head<2>();
          EXPECT_NEAR(spline(x), reference(x), 1e-9 * (1.0 + std::abs(reference(x))));
        }
      }
}

TEST(ThinPlateSpline, ReproducesPlanesForAnySmoothing) {
  Data data = makeOutline(50, 60.0);
  const auto plane = [](const Vec2& x) { return 700.0 + 0.3 * x.x() - 1.2 * x.y(); };
  for (std::size_t i = 0; i < data.sites.size(); ++i)
    data.values[i] = plane(data.sites[i]);
  for (const double smoothing : {0.0, 1e-6, 0.5, 1.0})
    for (const Vec2& x : {Vec2(0, 0), Vec2(120, -300), Vec2(500, 500)}) {
      EXPECT_NEAR(data.spline(smoothing)(x), plane(x), 1e-9);
    }
}

TEST(ThinPlateSpline, InterpolatesForSmoothingOneAndApproximatesBelow) {
  const Data data = makeOutline(50, 60.0);
  double maxError = 0.0, maxResidual = 0.0;
  for (std::size_t i = 0; i < data.sites.size(); ++i) {
    maxError = std::max(maxError, std::abs(data.spline(1.0)(data.sites[i]) - data.values[i]));
    maxResidual =
        std::max(maxResidual, std::abs(data.spline(0.01)(data.sites[i]) - data.values[i]));
  }
  EXPECT_LT(maxError, 1e-10);
  EXPECT_GT(maxResidual, 1e-3);
}

TEST(ThinPlateSpline, ZeroSmoothingGivesTheLeastSquaresPlane) {
  const Data data = makeOutline(50, 60.0);
  const ThinPlateSpline spline = data.spline(0.0);
  const Vec2 c(100, -280);
  EXPECT_NEAR(spline(c + Vec2(20, 30)) + spline(c - Vec2(20, 30)), 2 * spline(c), 1e-9);
  Vec3 normalEquations = Vec3::Zero(); // residuals are orthogonal to 1, x, y
  for (std::size_t i = 0; i < data.sites.size(); ++i) {
    const Vec2& x = data.sites[i];
    normalEquations += (spline(x) - data.values[i]) * Vec3(1, x.x(), x.y());
  }
  EXPECT_LT(normalEquations.norm(), 1e-7);
}

TEST(ThinPlateSpline, IsEquivariantUnderRotationTranslationAndScaling) {
  Random random(2, 0, 0);
  const Data data = makeScattered(random, 30, 40.0);
  const auto rotate = [c = std::cos(0.7), s = std::sin(0.7)](const Vec2& x) {
    return Vec2(c * x.x() - s * x.y(), s * x.x() + c * x.y());
  };
  for (const double s : {1.0, 0.01, 512.0}) {
    Data moved = data;
    for (Vec2& site : moved.sites)
      site = s * rotate(site) + Vec2(-300, 1000);
    // Smoothing is 1 / (1 + lambda), and lambda scales with s^2: for equal smoothing in mm, a
    // larger copy of a shape is smoothed less.
    const double lambda = (1.0 - 0.5) / 0.5 * s * s;
    const ThinPlateSpline a = data.spline(0.5), b = moved.spline(1.0 / (1.0 + lambda));
    for (const Vec2& x : {Vec2(0, 0), Vec2(17, -33), Vec2(-90, 120)}) {
      EXPECT_NEAR(a(x), b(s * rotate(x) + Vec2(-300, 1000)), 1e-7);
    }
  }
}

TEST(ThinPlateSpline, IsWellConditionedInTheUnitDisk) {
  Random random(3, 0, 0);
  for (const double radius : {1.0, 50.0, 300.0}) {
    EXPECT_LT(computeConditionNumber(makeOutline(50, radius).spline(0.5)), 3e3) << radius;
  }
}

TEST(ThinPlateSpline, RowsAgreeWithPoints) {
  const ThinPlateSpline spline = makeOutline(50, 60.0).spline(0.5);
  std::vector<double> x(131), values(x.size());
  for (std::size_t i = 0; i < x.size(); ++i)
    x[i] = 3.0 * static_cast<double>(i) - 50.0;
  spline.evaluateRow(x, -280.0, values);
  for (std::size_t i = 0; i < x.size(); ++i) {
    EXPECT_NEAR(values[i], spline(Vec2(x[i], -280.0)), 1e-10);
  }
}

/// Largest error of evaluateTile over a tile of samples every `pitch` mm.
double findMaxTileError(const ThinPlateSpline& spline, const Vec2& corner, double pitch,
                        std::size_t columns, std::size_t rows, double tolerance) {
  std::vector<double> x(columns), y(rows), values(columns * rows);
  for (std::size_t i = 0; i < columns; ++i)
    x[i] = corner.x() + pitch * static_cast<double>(i);
  for (std::size_t i = 0; i < rows; ++i)
    y[i] = corner.y() - pitch * static_cast<double>(i);
  spline.evaluateTile(x, y, tolerance, values);
  double maximum = 0.0;
  for (std::size_t i = 0; i < values.size(); i += 1 + values.size() / 100)
    maximum = std::max(maximum, std::abs(values[i] - spline({x[i % columns], y[i / columns]})));
  return maximum;
}

TEST(ThinPlateSpline, TilesAgreeWithPointsWithinTheTolerance) {
  Random random(4, 0, 0);
  double maximum = 0.0;
  std::uint64_t trials = 0; // a brief run tests only some of them
  for (const double radius : {0.5, 60.0, 300.0})
    for (const double smoothing : {0.0, 0.5, 1.0 - 1e-6, 1.0})
      for (const int count : {2, 3, 50, 300}) {
        Data data = makeScattered(random, count, radius);
        for (double& value : data.values)
          value *= 50.0; // jumps of 2000 mm
        const ThinPlateSpline spline = data.spline(smoothing);
        const double rounding = 1e-14 * computeConditionNumber(spline); // relative error of a point
        for (const double pitch : {1e-9 * radius, 1e-3 * radius, 0.01 * radius, 0.3 * radius})
          for (const double distanceRatio : {0.0, 1.0, 3.0, 30.0, 3e3})
            for (const auto& [columns, rows] : {std::pair{64, 64}, {64, 1}, {1, 1}, {5, 13}}) {
              const Vec2 corner = distanceRatio * radius * randomPoint(random, -1, 1).head<2>();
              ++trials; // the offset of every fourth varies the tested tile shape
              if ((trials + trials / 4) % fenestra::core::testing::slowdownFactor() != 0)
                continue;
              const double error =
                  findMaxTileError(spline, corner, pitch, static_cast<std::size_t>(columns),
                                   static_cast<std::size_t>(rows), 1e-6);
              ASSERT_LE(error, 1e-6 + rounding * (2000.0 + std::abs(spline(corner))))
                  << count << " sites in " << radius << " mm, p " << smoothing << ", " << columns
                  << "x" << rows << " every " << pitch << " mm at " << corner;
              maximum = std::max(maximum, smoothing == 0.5 && distanceRatio < 10.0 ? error : 0.0);
            }
      }
  std::printf("largest error at p = 0.5: %.1e mm\n", maximum);
}

TEST(LocalExpansion, EqualsTheSumOfItsTermsOrDoesNotExist) {
  Random random(5, 0, 0);
  const Vec2 center(0.3, -0.2);
  const double radius = 0.4;
  std::vector<KernelTerm> terms;
  for (int i = 0; i < 40; ++i) {
    const double angle = 6.0 * random.uniform(), nearest = radius / LocalExpansion::maxRatio;
    const double distance = nearest * (i == 0 ? 1.0 : uniform(random, 1, 5));
    terms.push_back(
        {center + distance * Vec2(std::cos(angle), std::sin(angle)), uniform(random, -1, 1)});
  }
  for (const double tolerance : {1e-2, 1e-6, 1e-10}) {
    const auto expansion = LocalExpansion::make(terms, center, radius, tolerance);
    ASSERT_TRUE(expansion);
    double maximum = 0.0;
    for (int i = 0; i < 1000; ++i) {
      const double angle = 6.3 * random.uniform();
      const Vec2 from = radius * Vec2(std::cos(angle), std::sin(angle));
      double sum = 0.0, value = 0.0;
      for (const KernelTerm& term : terms) {
        const double squared = (center + from - term.site).squaredNorm();
        sum += term.weight * squared * std::log(squared);
      }
      expansion->evaluateRow({&from.x(), 1}, from.y(), {&value, 1});
      maximum = std::max(maximum, std::abs(value - sum));
    }
    EXPECT_LE(maximum, tolerance);
    EXPECT_GE(maximum, 1e-5 * tolerance) << "more terms than necessary";
  }
  EXPECT_FALSE(LocalExpansion::make(terms, center, radius, 1e-16));
  terms[0].weight = 1e12;
  EXPECT_FALSE(LocalExpansion::make(terms, center, radius, 1e-6));
}

TEST(ThinPlateSpline, FewCoincidentOrCollinearSitesGiveAMeanOrALine) {
  const Data one{{{3, 4}}, {7}};
  EXPECT_NEAR(one.spline(0.5)({100, 100}), 7.0, 1e-12);
  const Data same{{{3, 4}, {3, 4}, {3, 4}}, {7, 8, 9}};
  EXPECT_NEAR(same.spline(1.0)({-9, 2}), 8.0, 1e-12);
  const Data two{{{0, 0}, {10, 0}}, {1, 2}};
  EXPECT_NEAR(two.spline(0.5)({20, 55}), 3.0, 1e-12);
  Data line;
  for (int i = 0; i < 30; ++i) {
    line.sites.push_back(Vec2(0.1 * i, 0.2 * i + 5.0));
    line.values.push_back(4.0 + i);
  }
  for (const double smoothing : {0.0, 0.5, 1.0}) {
    const ThinPlateSpline spline = line.spline(smoothing);
    EXPECT_NEAR(spline({1.0, 7.0}), 14.0, 1e-9);
    EXPECT_NEAR(spline(Vec2(1.0, 7.0) + 50.0 * Vec2(2, -1)), 14.0, 1e-9); // constant across it
  }
  const Data three{{{0, 0}, {10, 0}, {0, 10}}, {1, 2, 3}};
  EXPECT_NEAR(three.spline(0.5)({10, 10}), 4.0, 1e-12);
}

TEST(ThinPlateSpline, NearlyCoincidentSitesGiveFiniteValues) {
  Data data = makeOutline(50, 60.0);
  data.sites[1] = data.sites[0] + Vec2(1e-9, 0);
  data.values[1] = data.values[0] + 5.0;
  EXPECT_NEAR(data.spline(0.5)(data.sites[0]), data.values[0] + 2.5, 3.0);
}

} // namespace
} // namespace fenestra::core::ThinPlateSplineTests
