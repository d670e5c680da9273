#pragma once
// RGB estimates, and their comparison with closed forms.

#include "RunSettings.h"
#include "Support.h"

#include <gtest/gtest.h>

namespace fenestra::core::testing {

struct RgbEstimate {
  Rgb mean = Rgb::Zero(), error = Rgb::Zero(); ///< error: standard error of the mean

  RgbEstimate operator*(double factor) const { return {factor * mean, factor * error}; }
};

inline RgbEstimate operator+(const RgbEstimate& a, const RgbEstimate& b) {
  return {a.mean + b.mean, (a.error.square() + b.error.square()).sqrt()};
}

/// Mean radiance of an image, from every pixel's own error: pixels may differ.
inline RgbEstimate estimateRgb(const Film& film) {
  RgbEstimate sum;
  Rgb variance = Rgb::Zero();
  for (const PixelSums& pixel : film.pixels()) {
    sum.mean += pixel.mean;
    variance += pixel.standardError().square();
  }
  const auto n = static_cast<double>(film.pixelCount());
  return {sum.mean / n, variance.sqrt() / n};
}

/// Expects |mean - expected| <= 4 standard errors + `relativeError` * expected in every channel
/// (`relativeError`: that of `expected`), and a standard error <= `maxRelativeError` * expected. A
/// bias of 6 `maxRelativeError` * expected is then detected almost certainly.
inline void expectMean(const RgbEstimate& estimate, const Rgb& expected, double maxRelativeError,
                       double relativeError = 0.0) {
  for (int c = 0; c < 3; ++c) {
    const double tolerance = 4.0 * estimate.error[c] + relativeError * expected[c];
    EXPECT_NEAR(estimate.mean[c], expected[c], tolerance)
        << "channel " << c << ", z = " << (estimate.mean[c] - expected[c]) / estimate.error[c];
    EXPECT_LT(estimate.error[c], relaxError(maxRelativeError * expected[c])) << "channel " << c;
  }
}

} // namespace fenestra::core::testing
