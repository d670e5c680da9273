#pragma once
// The error that a filtered picture tells of itself, without any estimate of the samples' variance.
//
// A and B are the halves, of equal expectation m and independent; F_A is a function of A and of
// features, F_B of B and of features. (A choice among windows knows both; Judge keeps it from
// knowing the pixel's own noise.) For F = (F_A + F_B) / 2
//   (F - m)^2 = (F_A - F_B)^2 / 4 + (F_A - m)(F_B - m),
// and E[(F_A - A)(F_B - B)] = E[F_A - m] E[F_B - m] = E[(F_A - m)(F_B - m)], so
//   told = (F_A - F_B)^2 / 4 + (F_A - A)(F_B - B)
// is an unbiased estimate of the squared error, pixel by pixel: the first part is variance, the
// second is bias.

#include "denoise/filter/WindowFit.h"

namespace fenestra {

/// Told error of one pixel and channel in its two parts.
struct ErrorEstimate {
  float variance, bias;
};
inline ErrorEstimate estimateError(float fittedEven, float fittedOdd, float even, float odd) {
  const float difference = fittedEven - fittedOdd;
  return {0.25F * difference * difference, (fittedEven - even) * (fittedOdd - odd)};
}

/// Weight of a squared error, 1 / (x^2 + 0.01): errors are relative, except in the dark.
inline float relativeWeight(float x) {
  return 1.0F / (x * x + 0.01F);
}

/// Fills error, toldError and errorUncertainty of a picture whose colours are those before
/// clamping. `filtered`: the halves of fit.color, filtered. The variance part is averaged over 7x7
/// pixels. The bias part is too noisy for that: its sum over the picture is drawn toward a prior,
/// 0.65 of the variance (measured where windows suit a picture: 0.3 to 2), by its own standard
/// error, and spread half by its mean over 21x21 pixels, half by the variance part.
void estimateErrors(const FitInput& fit, const std::vector<Plane>& filtered, FilteredImage& image);

} // namespace fenestra
