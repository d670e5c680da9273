// Thin plate spline: against its solution with 50 digits, for ordinary and adversarial sites;
// against the functions that degenerate sites determine; and against itself in other units,
// positions and orders. Errors are relative to |f| and the range of the values (maxError).

#include "SplineStress.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <sstream>

namespace fenestra::core::SplineStressTests {
using namespace testing_clipping;

namespace {

constexpr std::array smoothings{0.0, 5e-324, 1e-300, 1e-12, 0.5, 1.0 - 1e-6, 1.0};
constexpr std::array origins{0.0, 120.3, 1e6};

/// Smoothing for the saddle system, which does not exist at p = 0. In double precision, its
/// solution at 1e-30 equals the limit.
double clampAboveZero(double smoothing) {
  return std::max(smoothing, 1e-30);
}

/// Expects the spline of `data` to equal the exact spline of `same`: the same data, or an
/// equivalent with merged sites.
void expectExact(const SplineData& data, const SplineData& same, double smoothing) {
  Random random(7, 0, 0);
  const ThinPlateSpline spline = data.spline(smoothing);
  EXPECT_LE(maxError(spline, same.exact(clampAboveZero(smoothing)),
                     makeEvaluationPoints(random, data, 8), data.range()),
            errorBound(spline));
}

void expectExact(const SplineData& data) {
  for (const double smoothing : smoothings) {
    SCOPED_TRACE(smoothing);
    expectExact(data, data, smoothing);
  }
}

// ---- against the exact solution

TEST(SplineStress, RandomSitesEqualFiftyDigitSolution) {
  Random random(1, 0, 0);
  constexpr int cases = 240;
  constexpr std::array ps{1e-3, 0.1, 0.5, 0.9, 1.0 - 1e-6, 1.0};
  double worst = 0.0, worstCondition = 0.0;
  for (int i = 0; i < cases; ++i) {
    const double p = ps[static_cast<std::size_t>(i) % ps.size()];
    const int count = 4 + static_cast<int>(46.999 * std::pow(random.uniform(), 2.0));
    const double radius = 0.5 * std::pow(1000.0, random.uniform());
    const double range = std::pow(10.0, uniform(random, -1, 3));
    const SplineData data = makeScattered(random, count, radius, sampleDisk(random, 1e3), range);
    const ThinPlateSpline spline = data.spline(p);
    const double error =
        maxError(spline, data.exact(p), makeEvaluationPoints(random, data, 6), data.range());
    EXPECT_LE(error, 1e-9) << count << " sites, radius " << radius << ", p " << p;
    worst = std::max(worst, error);
    worstCondition = std::max(worstCondition, computeConditionNumber(spline));
  }
  std::printf("%d cases: maximum relative error %.1e, condition number %.1e\n", cases, worst,
              worstCondition);
  RecordProperty("worstError", (std::ostringstream() << worst).str());
}

TEST(SplineStress, ThousandSitesEqualSaddleSystem) {
  // In a disk of 1 mm the saddle system is well enough conditioned for long double.
  Random random(2, 0, 0);
  const SplineData data = makeScattered(random, 1000, 1.0, {0.3, -0.2}, 500.0);
  const double p = 1.0 / (1.0 + 1e-4); // equals p = 0.5 in a disk of 100 mm
  const ThinPlateSpline spline = data.spline(p);
  const SaddleSpline<long double> exact(data.sites, data.values, p);
  EXPECT_LE(maxError(spline, exact, makeEvaluationPoints(random, data, 50), data.range()),
            errorBound(spline));
  const ThinPlateSpline through = data.spline(1.0);
  double miss = 0.0;
  for (std::size_t i = 0; i < data.sites.size(); ++i)
    miss = std::max(miss, std::abs(through(data.sites[i]) - data.values[i]));
  EXPECT_LE(miss, errorBound(through) * 1000.0);
}

TEST(SplineStress, DepthJumpsOnCircleAreExact) {
  SplineData data;
  for (int i = 0; i < 40; ++i) {
    const double angle = 2.0 * pi * i / 40;
    data.add(Vec2(10, 20) + 60.0 * Vec2(std::cos(angle), std::sin(angle)), i % 2 ? 1000.0 : 500.0);
  }
  expectExact(data);
  for (std::size_t i = 0; i < 40; ++i)
    data.values[i] = i < 20 ? 1000.0 : 500.0;
  expectExact(data);
}

TEST(SplineStress, ClustersAtTwoScalesAreExact) {
  for (const double width : {1e-3, 1e-6}) {
    Random random(3, 0, 0);
    SplineData data, centers;
    for (int cluster = 0; cluster < 5; ++cluster) {
      double mean = 0.0;
      for (int i = 0; i < 8; ++i) {
        const Vec2 center(100.0 * (cluster % 3), 100.0 * (cluster / 3));
        data.add(center + sampleDisk(random, width), 500.0 + 100.0 * cluster + random.uniform());
        mean += data.values.back() / 8.0;
      }
      centers.add(data.sites[data.sites.size() - 8], mean);
    }
    for (const double smoothing : {0.0, 1e-12, 0.5, 1.0 - 1e-6, 1.0}) {
      SCOPED_TRACE(std::to_string(width) + " mm, p " + std::to_string(smoothing));
      // At p = 1, sites closer than 1e-8 of the disk are merged.
      expectExact(data, smoothing == 1.0 && width == 1e-6 ? centers : data, smoothing);
    }
  }
}

TEST(SplineStress, NearlyCoincidentSitesAreExact) {
  for (const double distance : {1e-3, 1e-6, 1e-9, 1e-12})
    for (const double jump : {0.0, 1e-3, 500.0})
      for (const double smoothing : {0.0, 0.5, 1.0 - 1e-6, 1.0 - 1e-13, 1.0}) {
        SCOPED_TRACE(std::to_string(jump) + " mm over " + std::to_string(1e12 * distance) +
                     "e-12 mm, p " + std::to_string(smoothing));
        Random random(4, 0, 0);
        SplineData data = makeScattered(random, 20, 60.0, {0.0, 0.0}, 40.0);
        SplineData one = data;
        data.add(data.sites[0] + Vec2(distance, 0.0), data.values[0] + jump);
        one.values[0] += 0.5 * jump;
        expectExact(data, smoothing > 1.0 - 1e-9 && distance < 1e-5 ? one : data, smoothing);
      }
}

TEST(SplineStress, NearlyCollinearSitesAreExact) {
  for (const double breadth : {1e-3, 1e-6}) {
    Random random(5, 0, 0);
    SplineData data;
    for (int i = 0; i < 30; ++i)
      data.add({2.0 * i - 30.0, breadth * uniform(random, -1, 1)}, uniform(random, 500, 510));
    SCOPED_TRACE(breadth);
    expectExact(data);
  }
}

TEST(SplineStress, SitesInTinyDiskAreExact) {
  for (const double radius : {1e-3, 1e-6, 1e-12}) {
    Random random(6, 0, 0);
    SCOPED_TRACE(radius);
    expectExact(makeScattered(random, 20, radius, {0.0, 0.0}, 10.0));
  }
}

// ---- degenerate sites

TEST(SplineStress, NoSitesGiveZero) {
  for (const double smoothing : smoothings) {
    const ThinPlateSpline spline = SplineData{}.spline(smoothing);
    EXPECT_EQ(spline({1e4, -3.0}), 0.0);
    EXPECT_EQ(computeConditionNumber(spline), 1.0);
  }
}

TEST(SplineStress, OneSiteAndCoincidentSitesGiveTheirMean) {
  for (const double smoothing : smoothings)
    for (const double origin : origins)
      for (const int count : {1, 2, 3, 4, 10, 50, 1000}) {
        SplineData data;
        for (int i = 0; i < count; ++i)
          data.add({origin + 0.1, 0.7 - origin}, 500.0 + i);
        const double mean = 500.0 + 0.5 * (count - 1);
        const ThinPlateSpline spline = data.spline(smoothing);
        for (const Vec2& off : {Vec2(0, 0), Vec2(1e-9, 0), Vec2(-30, 2), Vec2(1e4, 1e4)}) {
          ASSERT_NEAR(spline(data.sites[0] + off), mean, 1e-12 * mean) << count;
        }
      }
}

TEST(SplineStress, CollinearSitesGiveTheirLeastSquaresLine) {
  const Vec2 along = Vec2(0.3, 0.7).normalized(), across(-along.y(), along.x());
  for (const double smoothing : smoothings)
    for (const double origin : origins)
      for (const double radius : {1e-3, 0.5, 500.0})
        for (const int count : {2, 3, 4, 50, 1000}) {
          Random random(8, 0, 0);
          SplineData data;
          long double n = 0, t = 0, tt = 0, z = 0, tz = 0;
          for (int i = 0; i < count; ++i) {
            const double position = radius * (2.0 * i / (count - 1) - 1.0);
            data.add(Vec2(origin, -origin) + position * along, uniform(random, 0, 500));
            const long double value = data.values.back();
            n += 1, t += position, tt += position * position, z += value, tz += position * value;
          }
          const long double slope = (n * tz - t * z) / (n * tt - t * t);
          const ThinPlateSpline spline = data.spline(smoothing);
          for (const double position : {0.0, 0.3 * radius, -radius, 1e4})
            for (const double offset : {0.0, radius, -1e4}) {
              const auto line = static_cast<double>((z - slope * t) / n + slope * position);
              const Vec2 x = Vec2(origin, -origin) + position * along + offset * across;
              // Rounding of the coordinates of sites and x, and of the slope.
              const double distance = std::hypot(position, offset);
              const double rounded = 1e-15 * (origin * (1.0 + distance / radius) + distance);
              ASSERT_NEAR(spline(x), line,
                          1e-9 * (data.range() + std::abs(line)) + data.range() / radius * rounded)
                  << count << " sites in " << radius << " mm at " << origin << ", p " << smoothing;
            }
        }
}

TEST(SplineStress, SitesCollinearTo1e9OfExtentAreConstantAcross) {
  Random random(16, 0, 0);
  SplineData data;
  for (int i = 0; i < 30; ++i)
    data.add({2.0 * i - 30.0, 3e-9 * uniform(random, -1, 1)}, uniform(random, 0, 500));
  for (const double smoothing : smoothings) {
    const ThinPlateSpline spline = data.spline(smoothing);
    EXPECT_NEAR(spline({7.0, 1e4}), spline({7.0, 0.0}), 1e-3);
  }
}

TEST(SplineStress, ThreeSitesGiveTheirPlane) {
  for (const double smoothing : smoothings)
    for (const double origin : origins)
      for (const double size : {1e-3, 1.0, 1e3}) {
        const Vec2 o(origin, -origin);
        SplineData data;
        data.add(o, 1.0);
        data.add(o + Vec2(size, 0), 2.0);
        data.add(o + Vec2(0, size), 501.0);
        for (const Vec2& at : {Vec2(0, 0), Vec2(1, 1), Vec2(-7, 1e4)}) {
          // Coordinates near 1e6 are rounded themselves.
          const Vec2 x = o + size * at, u = (x - o) / (data.sites[1].x() - o.x());
          const double plane = 1.0 + u.x() + 500.0 * u.y();
          const double error = 1e-9 + 1e-15 * origin / size;
          ASSERT_NEAR(data.spline(smoothing)(x), plane, error * (500.0 + std::abs(plane)));
        }
      }
}

// ---- invariances

/// Expects the spline of `moved` at map(x) to equal the spline of `data` at x.
template <typename Map>
void expectSame(const SplineData& data, double p, const SplineData& moved, double movedP,
                const Map& map, double bound) {
  Random random(9, 0, 0);
  const ThinPlateSpline a = data.spline(p), b = moved.spline(movedP);
  const auto atMoved = [&](const Vec2& x) { return b(map(x)); };
  EXPECT_LE(maxError(atMoved, a, makeEvaluationPoints(random, data, 50), data.range()), bound);
}

template <typename Map>
SplineData mapSites(const SplineData& data, const Map& map) {
  SplineData moved = data;
  std::ranges::transform(data.sites, moved.sites.begin(), map);
  return moved;
}

TEST(SplineStress, DoesNotDependOnUnit) {
  Random random(10, 0, 0);
  for (const int count : {5, 50, 300})
    for (const double lambda : {0.0, 1e-3, 1.0, 1e3})
      for (const double unit : {1e-3, 1.0 / 512.0, 25.4, 1e3}) { // mm
        const SplineData data = makeScattered(random, count, 40.0, {120, -300}, 40.0);
        const auto inUnit = [&](const Vec2& x) -> Vec2 { return x / unit; };
        const double same = 1.0 / (1.0 + lambda / (unit * unit));
        const double rounded = lambda > 0.0 ? 1e-16 * unit * unit / lambda : 0.0; // of 1 - p
        expectSame(data, 1.0 / (1.0 + lambda), mapSites(data, inUnit), same, inUnit,
                   1e-9 + rounded);
      }
}

TEST(SplineStress, IsInvariantToTranslation) {
  Random random(11, 0, 0);
  SplineData data = makeScattered(random, 50, 40.0, {0, 0}, 40.0);
  for (Vec2& site : data.sites) // multiples of 2^-12 mm, so that the shift is exact
    site = (site * 4096.0).array().round() / 4096.0;
  for (const Vec2& by : {Vec2(1, -7), Vec2(1e3, 2e3), Vec2(-1e6, 1e6)})
    for (const double smoothing : smoothings) {
      const ThinPlateSpline a = data.spline(smoothing);
      const ThinPlateSpline b =
          mapSites(data, [&](const Vec2& x) -> Vec2 { return x + by; }).spline(smoothing);
      for (int i = 0; i < 50; ++i) {
        const Vec2 x = (4096.0 * sampleDisk(random, 1e4)).array().round() / 4096.0;
        ASSERT_NEAR(a(x), b(x + by), 1e-12 * (data.range() + std::abs(a(x)))) << by;
      }
    }
}

TEST(SplineStress, IsInvariantToRotation) {
  Random random(12, 0, 0);
  for (const double origin : origins)
    for (const double smoothing : smoothings)
      for (const double angle : {1e-8, 0.7, 0.5 * pi, 3.0}) {
        const SplineData data = makeScattered(random, 50, 40.0, {0, 0}, 40.0);
        const auto rotate = [&](const Vec2& x) -> Vec2 {
          const double c = std::cos(angle), s = std::sin(angle);
          return {c * x.x() - s * x.y() + origin, s * x.x() + c * x.y() - origin};
        };
        // At 1e6 mm, coordinates are rounded by 1e-10 mm; slopes convert that into errors of f.
        const double bound = origin > 1e5 ? 1e-7 : 1e-9;
        expectSame(data, smoothing, mapSites(data, rotate), smoothing, rotate, bound);
      }
}

TEST(SplineStress, DoesNotDependOnOrderOfSites) {
  Random random(13, 0, 0);
  for (const double smoothing : smoothings) {
    const SplineData data = makeScattered(random, 50, 40.0, {120, -300}, 40.0);
    SplineData reversed = data;
    std::ranges::reverse(reversed.sites);
    std::ranges::reverse(reversed.values);
    expectSame(
        data, smoothing, reversed, smoothing, [](const Vec2& x) { return x; }, 1e-9);
  }
}

// ---- condition numbers

/// Wavy closed curve, similar to a contour.
SplineData makeOutline(int count, double radius) {
  SplineData data;
  for (int i = 0; i < count; ++i) {
    const double angle = 2.0 * pi * i / count;
    const double r = radius * (1.0 + 0.3 * std::cos(3.0 * angle));
    data.add(r * Vec2(std::cos(angle), std::sin(angle)), std::sin(5.0 * angle));
  }
  return data;
}

TEST(SplineStress, ConditionNumberEqualsRatioOfEigenvalues) {
  Random random(14, 0, 0);
  for (const SplineData& data :
       {makeOutline(50, 60.0), makeScattered(random, 30, 5.0, {10, 20}, 1.0)}) {
    for (const double lambda : {0.0, 1.0}) {
      const double expected = computeConditionByEigenvectors(data.sites, lambda);
      EXPECT_NEAR(computeConditionNumber(data.spline(1.0 / (1.0 + lambda))), expected,
                  1e-6 * expected);
    }
  }
}

TEST(SplineStress, ConditionNumberStaysSmall) {
  std::printf("condition number in the unit disk\n%10s %6s %10s %10s %10s\n", "", "N", "1 mm",
              "100 mm", "p = 1");
  for (const char* layout : {"outline", "disk"})
    for (const int count : {10, 50, 200, 1000}) {
      Random random(15, 0, 0);
      const auto sites = [&](double radius) {
        return *layout == 'o' ? makeOutline(count, radius)
                              : makeScattered(random, count, radius, Vec2::Zero(), 1.0);
      };
      const std::array conditions{computeConditionNumber(sites(1.0).spline(0.5)),
                                  computeConditionNumber(sites(100.0).spline(0.5)),
                                  computeConditionNumber(sites(100.0).spline(1.0))};
      std::printf("%10s %6d %10.1e %10.1e %10.1e\n", layout, count, conditions[0], conditions[1],
                  conditions[2]);
      RecordProperty(layout + std::to_string(count), std::to_string(conditions[1]));
      if (count == 50 && *layout == 'o') {
        EXPECT_LE(*std::ranges::max_element(conditions), 3e3);
      }
      // |phi| <= 4 ln 4 in the unit disk, so |K| <= 5.6 N; the outline's radius is up to 1.3.
      EXPECT_LE(conditions[0], 1.0 + 5.6 * 1.69 * count);
      EXPECT_LE(conditions[1], 1.0 + 5.6 * 1.69 * count * 1e4);
      EXPECT_LE(conditions[2], 5.6 * count * 1e12); // closer sites would be merged
    }
}

} // namespace
} // namespace fenestra::core::SplineStressTests
