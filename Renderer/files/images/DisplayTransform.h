#pragma once
// Maps radiance to display values, through OpenColorIO and Resources/color/fenestra.ocio. Exposure
// and tone apply only when a .png or .tif is encoded, so raw channels, noise estimates and metrics
// do not depend on them.
#include "files/images/Annotations.h"

#include <string_view>
#include <vector>

namespace fenestra::core {

/// Views of the configuration. `film`: for presentation; more mid-tone contrast, hues preserved.
/// `photographic`: for measurement; dark and middle values unchanged, applied per channel. Both
/// roll off toward white. `standard`: the sRGB encoding, clipped.
enum class DisplayView { film, photographic, standard };

/// Value of --tone that selects the view.
std::string_view toString(DisplayView view);

/// How display images show an image: settings of the display transform, and marks.
struct Display {
  DisplayView view = DisplayView::film;
  double exposure =
      0.0; ///< EV (stops): radiance is multiplied by 2^exposure, except for `standard`
  Annotations annotations = {};
};

/// Converts interleaved RGBA, linear Rec. 709 with premultiplied alpha, to sRGB-encoded values in
/// [0, 1] with straight alpha. Color is divided by alpha before exposure and view apply, and is
/// black where alpha is 0. NaN becomes black, infinity white. OpenColorIO's environment variables
/// have no effect.
std::vector<float> toDisplay(std::vector<float> rgba, const Display& display);

} // namespace fenestra::core
