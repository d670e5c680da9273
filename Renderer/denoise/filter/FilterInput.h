#pragma once
// Input and result of the filter: planes of one value a pixel.

#include "image/Image.h"

#include <array>
#include <cstdint>
#include <vector>

namespace fenestra {

/// Red, green and blue, premultiplied, and alpha.
using FourPlanes = std::array<Plane, 4>;

struct FilterInput {
  int width = 0, height = 0;
  /// Two estimates of the picture from independent samples, of equal expectation. Without halves
  /// (one sample a pixel) `even` is the picture, and `odd` is not read.
  FourPlanes even, odd;
  std::array<Plane, 3> variance; ///< of the mean over all samples, red, green and blue
  /// Functions of the scene alone: one that shares the samples' noise makes the filter believe that
  /// noise, and its told error a lie. At most SumLayout::maxFeatures, of any scale. Where one is
  /// not finite, the pixel stays raw.
  std::vector<Plane> features;
  std::vector<std::uint8_t> isActive; ///< 0: the pixel takes no part and stays raw
  bool hasHalfBuffers = true;

  std::size_t pixelCount() const { return isActive.size(); }
};

struct FilteredImage {
  FourPlanes color;           ///< colours not below 0, alpha in [0, 1]
  std::array<Plane, 3> error; ///< told standard error of red, green and blue
  /// Told mean over pixels and channels of error^2 / (x^2 + 0.01), and the standard error of that.
  double estimatedError = 0.0, errorUncertainty = 0.0;
};

} // namespace fenestra
