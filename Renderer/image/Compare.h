#pragma once
// Compares an image with a reference: error measures, and whether noise explains the difference.

#include "image/Image.h"

#include <cstddef>
#include <optional>

namespace fenestra::core {

/// Statistics of z = (a - b) / sqrt(se_a^2 + se_b^2) over pixels and R, G, B. Two independent
/// unbiased renders with correct standard errors give mean 0 and deviation 1. Excludes values whose
/// standard errors are both 0, and equal values with one standard error of 0 (background), all up
/// to float rounding.
struct ZStatistics {
  std::size_t count = 0; ///< values in the statistics
  double mean = 0.0, deviation = 0.0;
  double fractionAbove3 = 0.0; ///< fraction of |z| > 3; 0.0027 for normal noise
  double largest = 0.0;        ///< largest |z|
  int column = 0, row = 0;     ///< pixel of the largest
  char channel = 'R';          ///< channel of the largest
  /// Difference of the image means in combined standard errors.
  Rgb imageMean = Rgb::Zero();
};

/// Non-finite values make the measures that contain them NaN or infinite.
struct Comparison {
  double relMse = 0.0; ///< mean of ((a - b)^2 - se_b^2) / (b^2 + 0.01); se_b: 0 if b has no errors
  double rmse = 0.0;
  double psnr = infinity; ///< dB, peak 1; infinity for equal images
  double maxDifference = 0.0;
  Rgb meanA = Rgb::Zero(), meanB = Rgb::Zero();
  std::size_t notFinite = 0;    ///< values that are not finite in a or b
  std::optional<ZStatistics> z; ///< set if both images have error.R, error.G, error.B
};

/// Compares R, G and B of a render `a` with those of a reference `b`. Throws Error (input) for
/// different sizes or missing channels.
Comparison compareImages(const Image& a, const Image& b);

/// Image (R, G, B) of the differences: white for none, red for a > b, blue for a < b, black for
/// non-finite values. Shows the mean difference of the three channels, with full color at the
/// largest. If both images have errors, shows the z of largest magnitude instead, with full color
/// at 5. Throws like compareImages.
Image differenceImage(const Image& a, const Image& b);

/// Copies R, G, B of `error`, an image of standard errors, to the error channels of `image`.
/// Throws Error (input) for different sizes or missing channels.
void attachError(Image& image, const Image& error);

} // namespace fenestra::core
