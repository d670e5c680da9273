#pragma once
// Sites and values for stress tests of the thin plate spline, and its solution with 50 digits.

#include "SaddleSpline.h"
#include "SplineCondition.h"
#include "Unit/ClippingTesting.h"
#include "clip/surface/ThinPlateSpline.h"

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/eigen.hpp>

#include <vector>

namespace fenestra::core::testing_clipping {

using FiftyDigits = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<50>,
                                                  boost::multiprecision::et_off>;

struct SplineData {
  std::vector<Vec2> sites;
  std::vector<double> values;

  void add(const Vec2& site, double value) {
    sites.push_back(site);
    values.push_back(value);
  }
  ThinPlateSpline spline(double smoothing) const { return {sites, values, smoothing}; }
  SaddleSpline<FiftyDigits> exact(double smoothing) const { return {sites, values, smoothing}; }

  /// Maximum - minimum of the values, mm.
  double range() const {
    const auto [least, greatest] = std::ranges::minmax(values);
    return greatest - least;
  }
  /// Maximum distance from the first site, mm.
  double extent() const {
    double extent = 0.0;
    for (const Vec2& site : sites)
      extent = std::max(extent, (site - sites[0]).norm());
    return extent;
  }
};

inline Vec2 sampleDisk(Random& random, double radius) {
  const double angle = uniform(random, 0.0, 2.0 * pi);
  return radius * std::sqrt(random.uniform()) * Vec2(std::cos(angle), std::sin(angle));
}

/// Random sites in a disk, random values in [500, 500 + range] mm.
inline SplineData makeScattered(Random& random, int count, double radius, const Vec2& center,
                                double range) {
  SplineData data;
  for (int i = 0; i < count; ++i)
    data.add(center + sampleDisk(random, radius), 500.0 + range * random.uniform());
  return data;
}

/// Evaluation points: about eight of the sites, points 1e-9 mm from these, `near` points within
/// three extents of the first site, and four points 10 m away.
inline std::vector<Vec2> makeEvaluationPoints(Random& random, const SplineData& data, int near) {
  std::vector<Vec2> points;
  for (std::size_t i = 0; i < data.sites.size(); i += 1 + data.sites.size() / 8) {
    points.push_back(data.sites[i]);
    points.push_back(data.sites[i] + Vec2(1e-9, -1e-9));
  }
  for (int i = 0; i < near; ++i)
    points.push_back(data.sites[0] + sampleDisk(random, 3.0 * data.extent()));
  for (int i = 0; i < 4; ++i)
    points.push_back(data.sites[0] + 1e4 * Vec2(std::cos(1.7 * i), std::sin(1.7 * i)));
  return points;
}

/// Error norm of all bounds: maximum |f - g| / (range of the values + |g|) over the points;
/// infinity if f is not finite at a point.
template <typename F, typename G>
double maxError(const F& f, const G& g, const std::vector<Vec2>& points, double range) {
  double worst = 0.0;
  for (const Vec2& x : points) {
    const double exact = g(x), error = std::abs(f(x) - exact);
    worst = std::max(worst, std::isfinite(error) ? error / (range + std::abs(exact)) : infinity);
  }
  return worst;
}

/// Error bound documented in ThinPlateSpline.h, at least 1e-9.
inline double errorBound(const ThinPlateSpline& spline) {
  return std::max(1e-9, 1e-14 * computeConditionNumber(spline));
}

} // namespace fenestra::core::testing_clipping
