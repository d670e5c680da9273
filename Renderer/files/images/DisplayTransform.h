#pragma once
// Radiance to display values, by the views of Resources/color/fenestra.ocio.

#include <string_view>
#include <vector>

namespace fenestra {

/// Views of the configuration. `film`: for pictures to look at, contrast in the middle, colours
/// keep their hue. `photographic`: for measuring, dark and middle values as they are, channel by
/// channel. Both roll off below white. `standard`: the sRGB encoding, clipped.
enum class DisplayView { film, photographic, standard };

/// Name of a view, as --tone has it.
std::string_view toString(DisplayView view);

/// How radiance is shown.
struct Display {
  DisplayView view = DisplayView::film;
  double exposure =
      0.0; ///< stops, EV; radiance is multiplied by 2^exposure, but not for `standard`
};

/// Display values, sRGB-encoded and in [0, 1], of a picture in linear Rec. 709, R G B A by pixel.
/// NaN becomes black, infinity white. Alpha becomes straight: colours are divided by alpha before
/// exposure and view apply; black where alpha is 0. OpenColorIO's environment variables have no
/// effect.
std::vector<float> toDisplay(std::vector<float> rgba, const Display& display);

} // namespace fenestra
