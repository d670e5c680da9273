#pragma once
// Error estimate of a filtered image from its half buffers. Like the dual-buffer MSE estimates of
// Rousselle et al. 2012 and Bitterli et al. 2016, but without an estimate of the samples' variance.
//
// A and B are the half buffers: independent, with equal expectation m. F_A is a function of A and
// the features, F_B of B and the features. (The selection among windows depends on both;
// CandidateScorer excludes the pixel's own noise from it.) For F = (F_A + F_B) / 2
//   (F - m)^2 = (F_A - F_B)^2 / 4 + (F_A - m)(F_B - m),
// and E[(F_A - A)(F_B - B)] = E[F_A - m] E[F_B - m] = E[(F_A - m)(F_B - m)], so
//   estimate = (F_A - F_B)^2 / 4 + (F_A - A)(F_B - B)
// is an unbiased estimate of the squared error of each pixel. The first part is variance, the
// second bias.

#include "denoise/filter/WindowFit.h"

namespace fenestra::core {

/// Estimated squared error of a pixel and channel, in two parts.
struct ErrorEstimate {
  float variance, bias;
};
inline ErrorEstimate estimateError(float fittedEven, float fittedOdd, float even, float odd) {
  const float difference = fittedEven - fittedOdd;
  return {0.25F * difference * difference, (fittedEven - even) * (fittedOdd - odd)};
}

/// Weight of a squared error, 1 / (x^2 + 0.01): makes errors relative, except in dark pixels.
inline float relativeWeight(float x) {
  return 1.0F / (x * x + 0.01F);
}

/// Sets error, estimatedError and errorUncertainty of an image whose colors are not yet clamped.
/// `filtered`: both halves of fit.color, filtered. The variance part is averaged over 7x7 pixels.
/// The bias part is too noisy for that: its sum over the image is shrunk, according to its standard
/// error, toward a prior of 0.65 of the variance (0.3 to 2 were measured on images that suit the
/// filter). It is distributed half by its mean over 21x21 pixels, half by the variance part.
void estimateErrors(const FitInput& fit, const std::vector<Plane>& filtered, FilteredImage& image);

} // namespace fenestra::core
