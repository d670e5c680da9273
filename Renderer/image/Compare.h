#pragma once
// How far a picture is from a reference, and whether its own noise explains the difference.

#include "image/Image.h"

#include <cstddef>
#include <optional>

namespace fenestra {

/// Statistics of z = (a - b) / sqrt(se_a^2 + se_b^2) over pixels and R, G, B; of two independent
/// unbiased renders with honest errors it has mean 0 and deviation 1. Values are left out
/// where both standard errors are 0 to the rounding of a float, or one is and the values agree to
/// it (a background that neither renderer saw anything in front of).
struct ZStatistics {
  std::size_t count = 0; ///< values in the statistics
  double mean = 0.0, deviation = 0.0;
  double shareAbove3 = 0.0; ///< of |z| > 3; 0.0027 for normal noise
  double largest = 0.0;     ///< |z|
  int column = 0, row = 0;  ///< where the largest is
  char channel = 'R';       ///< which it is
  /// Difference of the image means in combined standard errors.
  Rgb imageMean = Rgb::Zero();
};

/// A value that is not finite in either picture makes the measures that it enters NaN or infinite.
struct Comparison {
  double relMse = 0.0; ///< mean of (a - b)^2 / (b^2 + 0.01), less that of se_b^2 if b states errors
  double rmse = 0.0;
  double psnr = infinity; ///< dB, peak 1; infinity for equal pictures
  double maxDifference = 0.0;
  Rgb meanA = Rgb::Zero(), meanB = Rgb::Zero();
  std::size_t notFinite = 0;    ///< values that are not finite in a or b
  std::optional<ZStatistics> z; ///< where both pictures carry error.R, error.G, error.B
};

/// Compares R, G and B of a render `a` with those of a reference `b`. Throws Error (input) for
/// different sizes or missing channels.
Comparison compareImages(const Image& a, const Image& b);

/// A picture of the differences, R, G, B: white where there is none, red where a is above b, blue
/// where it is below. It shows the mean difference of the three channels, in full colour at the
/// largest; or, where both pictures carry errors, the z of largest modulus, in full colour at 5.
/// Black where a difference is not finite. Throws as compareImages does.
Image differenceImage(const Image& a, const Image& b);

/// Means over square tiles of `size` pixels (fewer at the right and lower border, so one tile of a
/// great size is the whole picture): R, G, B, their standard errors, and the sum of samples.N.
/// Needs error.R, error.G, error.B and samples.N, and throws Error (input) where one is missing.
Image tileMeans(const Image& image, int size);

/// How probable a difference as large as the largest of any R, G or B is between two renders of one
/// scene with independent seeds: Student's t of each value, corrected for the number of values
/// (Šidák 1967). The two share their variance a sample. A mean of few bright paths is skewed as a
/// count of them is, so t has no more degrees of freedom than the shorter render would have paths,
/// were they equally bright (mean^2 / se^2): its tails are then the heavier ones. Exact values (see
/// ZStatistics) that differ make the probability 0; so does what is not finite. Throws as tileMeans
/// does, and for a missing samples.N and different sizes.
double agreementProbability(const Image& a, const Image& b);

/// Takes R, G, B of `error`, a picture of standard errors, as the error channels of `image`. Throws
/// Error (input) for different sizes or missing channels.
void attachError(Image& image, const Image& error);

} // namespace fenestra
