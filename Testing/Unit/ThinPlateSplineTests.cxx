// The spline solved in the unit disc is the spline that the equations state in mm.

#include "ClippingTesting.h"
#include "SaddleSpline.h"
#include "clipping/ThinPlateSpline.h"

#include <gtest/gtest.h>

using namespace fenestra;
using namespace fenestra::testing_clipping;

namespace {

struct Data {
  std::vector<Vec2> sites;
  std::vector<double> values;

  ThinPlateSpline spline(double smoothing) const { return {sites, values, smoothing}; }
};

/// Sites on a wavy closed curve around (120, -300) mm, about `radius` mm from it.
Data outline(int count, double radius) {
  Data data;
  for (int i = 0; i < count; ++i) {
    const double angle = 2.0 * pi * i / count;
    const double r = radius * (1.0 + 0.3 * std::cos(3.0 * angle));
    data.sites.push_back(Vec2(120.0, -300.0) + r * Vec2(std::cos(angle), std::sin(angle)));
    data.values.push_back(500.0 + 10.0 * std::sin(2.0 * angle) + 0.1 * r);
  }
  return data;
}

Data scattered(Random& random, int count, double radius) {
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

TEST(ThinPlateSpline, IsTheSaddleSystemsSolutionInMillimetres) {
  Random random(1, 0, 0);
  for (const double radius : {0.5, 8.0, 100.0})
    for (const double smoothing : {0.1, 0.5, 0.9, 1.0})
      for (const Data& data : {outline(50, radius), scattered(random, 20, radius)}) {
        const ThinPlateSpline spline = data.spline(smoothing);
        const SaddleSpline<long double> reference(data.sites, data.values, smoothing);
        for (int i = 0; i < 50; ++i) {
          const Vec2 x = data.sites[0] + 3.0 * radius * randomPoint(random, -1, 1).head<2>();
          EXPECT_NEAR(spline(x), reference(x), 1e-9 * (1.0 + std::abs(reference(x))));
        }
      }
}

TEST(ThinPlateSpline, ReproducesPlanesWhateverTheSmoothing) {
  Data data = outline(50, 60.0);
  const auto plane = [](const Vec2& x) { return 700.0 + 0.3 * x.x() - 1.2 * x.y(); };
  for (std::size_t i = 0; i < data.sites.size(); ++i)
    data.values[i] = plane(data.sites[i]);
  for (const double smoothing : {0.0, 1e-6, 0.5, 1.0})
    for (const Vec2& x : {Vec2(0, 0), Vec2(120, -300), Vec2(500, 500)}) {
      EXPECT_NEAR(data.spline(smoothing)(x), plane(x), 1e-9);
    }
}

TEST(ThinPlateSpline, InterpolatesAtOneAndApproximatesBelow) {
  const Data data = outline(50, 60.0);
  double worst = 0.0, missed = 0.0;
  for (std::size_t i = 0; i < data.sites.size(); ++i) {
    worst = std::max(worst, std::abs(data.spline(1.0)(data.sites[i]) - data.values[i]));
    missed = std::max(missed, std::abs(data.spline(0.01)(data.sites[i]) - data.values[i]));
  }
  EXPECT_LT(worst, 1e-10);
  EXPECT_GT(missed, 1e-3);
}

TEST(ThinPlateSpline, AtZeroIsTheLeastSquaresPlane) {
  const Data data = outline(50, 60.0);
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

TEST(ThinPlateSpline, TurnsShiftsAndScalesWithItsSites) {
  Random random(2, 0, 0);
  const Data data = scattered(random, 30, 40.0);
  const Eigen::Rotation2Dd turn(0.7);
  for (const double s : {1.0, 0.01, 512.0}) {
    Data moved = data;
    for (Vec2& site : moved.sites)
      site = s * (turn * site) + Vec2(-300, 1000);
    // lambda goes with s^2: in mm, the same shape larger is smoothed less.
    const double lambda = (1.0 - 0.5) / 0.5 * s * s;
    const ThinPlateSpline a = data.spline(0.5), b = moved.spline(1.0 / (1.0 + lambda));
    for (const Vec2& x : {Vec2(0, 0), Vec2(17, -33), Vec2(-90, 120)}) {
      EXPECT_NEAR(a(x), b(s * (turn * x) + Vec2(-300, 1000)), 1e-7);
    }
  }
}

TEST(ThinPlateSpline, IsWellConditionedInTheUnitDisc) {
  Random random(3, 0, 0);
  for (const double radius : {1.0, 50.0, 300.0}) {
    EXPECT_LT(outline(50, radius).spline(0.5).conditionNumber(), 3e3) << radius;
  }
}

TEST(ThinPlateSpline, RowsAgreeWithPoints) {
  const ThinPlateSpline spline = outline(50, 60.0).spline(0.5);
  std::vector<double> x(131), values(x.size());
  for (std::size_t i = 0; i < x.size(); ++i)
    x[i] = 3.0 * static_cast<double>(i) - 50.0;
  spline.evaluateRow(x, -280.0, values);
  for (std::size_t i = 0; i < x.size(); ++i) {
    EXPECT_NEAR(values[i], spline(Vec2(x[i], -280.0)), 1e-10);
  }
}

TEST(ThinPlateSpline, FewCoincidentOrCollinearSitesGiveWhatTheyDetermine) {
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
    EXPECT_NEAR(spline(Vec2(1.0, 7.0) + 50.0 * Vec2(2, -1)), 14.0, 1e-9); // level across the line
  }
  const Data three{{{0, 0}, {10, 0}, {0, 10}}, {1, 2, 3}};
  EXPECT_NEAR(three.spline(0.5)({10, 10}), 4.0, 1e-12);
}

TEST(ThinPlateSpline, NearlyCoincidentSitesStayFinite) {
  Data data = outline(50, 60.0);
  data.sites[1] = data.sites[0] + Vec2(1e-9, 0);
  data.values[1] = data.values[0] + 5.0;
  EXPECT_NEAR(data.spline(0.5)(data.sites[0]), data.values[0] + 2.5, 3.0);
}

} // namespace
