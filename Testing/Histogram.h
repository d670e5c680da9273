#pragma once
// Chi-squared test of whether a sampling routine matches the pdf that it states: directions are
// binned on the sphere and compared with the integral of the pdf over each bin.

#include "base/Random.h"

#include <gtest/gtest.h>

#include <vector>

namespace fenestra::core::testing {

struct SphereBins {
  static constexpr int rows = 12;    ///< equal in cos(theta)
  static constexpr int columns = 16; ///< equal in phi
  static constexpr int count = rows * columns;

  static int index(const Vec3& d) {
    const int row = std::min(static_cast<int>(0.5 * (1.0 - d.z()) * rows), rows - 1);
    const double phi = std::atan2(d.y(), d.x()) / (2.0 * pi) + 0.5;
    return std::min(static_cast<int>(phi * columns), columns - 1) + columns * std::max(row, 0);
  }

  static Vec3 toDirection(double row, double column) {
    const double z = 1.0 - 2.0 * row / rows;
    const double r = std::sqrt(std::max(0.0, 1.0 - z * z));
    const double phi = 2.0 * pi * (column / columns - 0.5);
    return {r * std::cos(phi), r * std::sin(phi), z};
  }
};

/// Integral of pdf(direction) over each bin: midpoint rule on `resolution`^2 points per bin.
template <typename Pdf>
std::vector<double> integrateBins(Pdf&& pdf, int resolution) {
  std::vector<double> expected(SphereBins::count, 0.0);
  const double pointArea = 4.0 * pi / (SphereBins::count * resolution * resolution);
  for (int bin = 0; bin < SphereBins::count; ++bin)
    for (int i = 0; i < resolution; ++i)
      for (int j = 0; j < resolution; ++j)
        expected[static_cast<std::size_t>(bin)] +=
            pointArea *
            pdf(SphereBins::toDirection(bin / SphereBins::columns + (i + 0.5) / resolution,
                                        bin % SphereBins::columns + (j + 0.5) / resolution));
  return expected;
}

/// z-score of Pearson's chi-squared of observed against expected counts (Wilson and Hilferty 1931).
/// Bins with an expected count below 10 are pooled.
inline double chiSquaredZScore(const std::vector<double>& observed,
                               const std::vector<double>& expected) {
  double chi2 = 0.0;
  double pooledObserved = 0.0;
  double pooledExpected = 0.0;
  int bins = 0;
  for (std::size_t i = 0; i < observed.size(); ++i) {
    if (expected[i] < 10.0) {
      pooledObserved += observed[i];
      pooledExpected += expected[i];
      continue;
    }
    chi2 += std::pow(observed[i] - expected[i], 2.0) / expected[i];
    ++bins;
  }
  if (pooledExpected >= 10.0) {
    chi2 += std::pow(pooledObserved - pooledExpected, 2.0) / pooledExpected;
    ++bins;
  }
  const double dof = std::max(1, bins - 1);
  const double a = 2.0 / (9.0 * dof);
  return (std::cbrt(chi2 / dof) - (1.0 - a)) / std::sqrt(a);
}

/// `sample(random)`: a direction, or zero if the sample has none. `pdf`: per steradian, integrates
/// to `mass` (1 if every sample has a direction).
template <typename Sample, typename Pdf>
void expectSamplingMatchesPdf(Sample&& sample, Pdf&& pdf, double mass = 1.0, int resolution = 60) {
  const std::vector<double> integrals = integrateBins(pdf, resolution);
  double total = 0.0;
  for (const double x : integrals)
    total += x;
  EXPECT_NEAR(total, mass, 2e-3);

  constexpr int n = 400000;
  std::vector<double> observed(integrals.size(), 0.0);
  std::vector<double> expected = integrals;
  for (double& x : expected)
    x *= n;
  for (int i = 0; i < n; ++i) {
    Random random(31, static_cast<std::uint64_t>(i), 0);
    const Vec3 d = sample(random);
    if (d.squaredNorm() > 0.0)
      observed[static_cast<std::size_t>(SphereBins::index(d))] += 1.0;
  }
  EXPECT_LT(chiSquaredZScore(observed, expected), 4.5);
}

} // namespace fenestra::core::testing
