#pragma once
// A filter for the eye: least squares in windows of four sizes, the size chosen pixel by pixel by
// the error that the filter tells of itself (ToldError.h). Biased, and never a part of the raw
// channels.

#include "denoise/filter/WindowFit.h"

namespace fenestra {

inline constexpr int filterVersion = 1; ///< changes whenever filtered pictures do

/// Filters both halves, each by itself, with the same features; the picture is their mean. Raw is
/// one of the candidates. Without halves windows have one size, and the errors are empty.
/// Independent of threads.
FilteredImage filterImage(FilterInput input);

/// fit.color, filtered by windows of the sizes that tell the least error, pixel by pixel.
/// `variance`: of the mean of both halves.
std::vector<Plane> filterAdaptively(const FitInput& fit, const std::array<Plane, 3>& variance);

} // namespace fenestra
