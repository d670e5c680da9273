#pragma once
// Radiance to display values, by the views of Resources/color/fenestra.ocio.

#include "image/Image.h"

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace fenestra {

class DisplayTransform {
public:
  /// Loads a view by name; empty: the first, photographic one. Throws Error (usage) for an unknown
  /// name. OpenColorIO's environment variables have no effect.
  explicit DisplayTransform(const std::string& view = "");
  ~DisplayTransform();

  /// Converts `count` triples in place: linear Rec. 709 to sRGB-encoded display values in [0, 1].
  /// NaN becomes black, infinity white.
  void apply(float* rgb, std::size_t count) const;

private:
  struct Processor;
  std::unique_ptr<const Processor> m_processor;
};

/// Display values of a picture: width * height * 4 floats in [0, 1], RGBA by pixel. R, G, B are
/// required; without A the picture is opaque. Alpha is straight: colours are divided by alpha
/// before the view applies; black where alpha is 0.
std::vector<float> toDisplay(const Image& image, const DisplayTransform& transform);

} // namespace fenestra
