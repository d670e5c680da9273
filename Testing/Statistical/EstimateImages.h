#pragma once
// Converts estimates to images, for error images and for comparisons of images.

#include "Oracle/Estimates.h"
#include "image/Image.h"

namespace fenestra::core::testing {

/// Image with R, G, B, error.R, error.G, error.B and samples.N.
inline Image toImage(const oracle::Estimates& estimates) {
  Image image{estimates.width, estimates.height, {}, {}};
  constexpr const char* colors[] = {"R", "G", "B"};
  for (const oracle::PixelEstimate& pixel : estimates.pixels) {
    for (int c = 0; c < 3; ++c) {
      image.channels[colors[c]].push_back(static_cast<float>(pixel.mean[c]));
      image.channels[std::string("error.") + colors[c]].push_back(
          static_cast<float>(std::sqrt(pixel.variance()[c])));
    }
    image.channels["samples.N"].push_back(static_cast<float>(pixel.samples));
  }
  return image;
}

} // namespace fenestra::core::testing
