#pragma once
// Radiance to display values, by the views of Resources/color/fenestra.ocio.

#include <vector>

namespace fenestra {

/// `photographic`: for renders, rolls off below white. `standard`: the sRGB encoding, clipped.
enum class DisplayView { photographic, standard };

/// Display values, sRGB-encoded and in [0, 1], of a picture in linear Rec. 709, R G B A by pixel.
/// NaN becomes black, infinity white. Alpha becomes straight: colours are divided by alpha before
/// the view applies; black where alpha is 0. OpenColorIO's environment variables have no effect.
std::vector<float> toDisplay(std::vector<float> rgba, DisplayView view);

} // namespace fenestra
