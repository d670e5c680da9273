#pragma once
// Colours as people tell them apart, the colour-blind included.

#include "base/Vector.h"

#include <array>

namespace fenestra {

/// Normal sight, and dichromacy: no working cones for long, middle, or short waves.
enum class ColorVision { normal, protan, deutan, tritan };
inline constexpr std::array colorVisions = {ColorVision::normal, ColorVision::protan,
                                            ColorVision::deutan, ColorVision::tritan};

/// Linear Rec. 709 that looks to normal sight as `linear` does to this one: Machado, Oliveira,
/// Fernandes 2009 ("A Physiologically-based Model for Simulation of Color Vision Deficiency"),
/// severity 1. Clamped to [0, 1].
Rgb simulateVision(ColorVision vision, const Rgb& linear);

/// CIELAB, D65, 2 degrees.
struct Lab {
  double L, a, b;
};

/// CIELAB of linear Rec. 709, in which 1 is the display's white.
Lab toLab(const Rgb& linear);
/// Its inverse; beyond [0, 1] where the display has no such colour.
Rgb toLinear(const Lab& lab);

/// Colour difference of 1976: the distance in CIELAB.
double deltaE76(const Lab& x, const Lab& y);
/// CIEDE2000 (Sharma, Wu, Dalal 2005, eq. 2 to 22), k_L = k_C = k_H = 1.
double deltaE2000(const Lab& x, const Lab& y);

} // namespace fenestra
