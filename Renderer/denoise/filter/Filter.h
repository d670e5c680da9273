#pragma once
// Denoiser of display images: linear regression of the colors on noise-free features (albedo,
// normal, depth, light) in windows of four sizes. The size is selected per pixel by the estimated
// error (ErrorEstimate.h). The filter is biased, and never applied to the raw channels.
//
// The error estimate uses the half buffers only. It is valid only if the features are functions of
// the scene, independent of the samples. Features are therefore ray-marched (denoise/features).

#include "denoise/filter/WindowFit.h"

namespace fenestra::core {

inline constexpr int filterVersion = 1; ///< changes whenever filtered images do

/// Filters both half buffers separately, with the same features, and returns their mean. The
/// unfiltered image is one of the candidates. Without half buffers there is one window size, and
/// the error estimates are empty. Independent of the number of threads.
FilteredImage filterImage(FilterInput input);

/// Filters fit.color with the window size of the smallest estimated error per pixel. `variance`: of
/// the mean of both half buffers.
std::vector<Plane> filterAdaptively(const FitInput& fit, const std::array<Plane, 3>& variance);

} // namespace fenestra::core
