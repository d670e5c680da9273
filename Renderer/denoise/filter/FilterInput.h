#pragma once
// Input and result of the filter: planes with one value per pixel.

#include "base/StopFlag.h"
#include "image/Image.h"

#include <array>
#include <cstdint>
#include <vector>

namespace fenestra::core {

/// Red, green and blue, premultiplied, and alpha.
using FourPlanes = std::array<Plane, 4>;

struct FilterInput {
  int width = 0, height = 0;
  /// Half buffers: two independent estimates of the image, with equal expectation. Without them
  /// (one sample per pixel), `even` is the image and `odd` is ignored.
  FourPlanes even, odd;
  std::array<Plane, 3> variance; ///< of the mean over all samples: red, green and blue
  /// Must depend on the scene only. Features that correlate with the samples' noise would preserve
  /// it, and invalidate the error estimate. At most SumLayout::maxFeatures, of any scale. Pixels
  /// with a non-finite feature stay unfiltered.
  std::vector<Plane> features;
  std::vector<std::uint8_t> isActive; ///< 0: the pixel is ignored and stays unfiltered
  bool hasHalfBuffers = true;
  const StopFlag* stop = &neverStopped; ///< once true, the filter returns soon with any result

  std::size_t pixelCount() const { return isActive.size(); }
};

struct FilteredImage {
  FourPlanes color;           ///< colors >= 0, alpha in [0, 1]
  std::array<Plane, 3> error; ///< estimated standard error of red, green and blue
  /// Estimated mean over pixels and channels of error^2 / (x^2 + 0.01), and its standard error.
  double estimatedError = 0.0, errorUncertainty = 0.0;
};

} // namespace fenestra::core
