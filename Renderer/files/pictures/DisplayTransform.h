#pragma once
// From radiance to what a display shows: the views of Resources/color/fenestra.ocio.

#include "image/Image.h"

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace fenestra {

class DisplayTransform {
public:
  /// A view by its name; by default the first, photographic one. Throws Error (usage) for an
  /// unknown name. Environment variables of OpenColorIO have no say.
  explicit DisplayTransform(const std::string& view = "");
  ~DisplayTransform();

  /// `count` triples, in place: linear Rec. 709 to sRGB-encoded display values in [0, 1]. NaN shows
  /// as black, infinity as white.
  void apply(float* rgb, std::size_t count) const;

private:
  struct Processor;
  std::unique_ptr<const Processor> m_processor;
};

/// R, G, B (which must be there) and A (opaque if not) of a picture as display values: width *
/// height
/// * 4 floats in [0, 1], RGBA by pixel. Alpha is straight: colours are divided by it before the
/// view applies, and black where it is 0.
std::vector<float> toDisplay(const Image& image, const DisplayTransform& transform);

} // namespace fenestra
