#pragma once
// What tests against closed forms share: estimates, and their comparison.

#include "RunSettings.h"
#include "Support.h"

#include <gtest/gtest.h>

namespace fenestra::testing {

struct RgbEstimate {
  Rgb mean = Rgb::Zero(), error = Rgb::Zero(); ///< error: standard, of the mean

  RgbEstimate operator*(double factor) const { return {factor * mean, factor * error}; }
};

inline RgbEstimate operator+(const RgbEstimate& a, const RgbEstimate& b) {
  return {a.mean + b.mean, (a.error.square() + b.error.square()).sqrt()};
}

/// Mean radiance of a picture. Its pixels need not be alike: each brings its own error.
inline RgbEstimate pictureEstimate(const Film& film) {
  RgbEstimate sum;
  Rgb variance = Rgb::Zero();
  for (const PixelSums& pixel : film.pixels()) {
    sum.mean += pixel.mean;
    variance += pixel.standardError().square();
  }
  const auto n = static_cast<double>(film.pixelCount());
  return {sum.mean / n, variance.sqrt() / n};
}

/// Every channel within 4 standard errors of what is expected, which itself is known to `known`
/// (relative). The standard error is at most `sharpness` of the expected value, so that a bias of 6
/// times that is found all but surely.
inline void expectMean(const RgbEstimate& estimate, const Rgb& expected, double sharpness,
                       double known = 0.0) {
  for (int c = 0; c < 3; ++c) {
    const double tolerance = 4.0 * estimate.error[c] + known * expected[c];
    EXPECT_NEAR(estimate.mean[c], expected[c], tolerance)
        << "channel " << c << ", z = " << (estimate.mean[c] - expected[c]) / estimate.error[c];
    EXPECT_LT(estimate.error[c], allowedError(sharpness * expected[c])) << "channel " << c;
  }
}

} // namespace fenestra::testing
