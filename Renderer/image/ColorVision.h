#pragma once
// Perceptual color differences, for normal and color-deficient vision.

#include "base/Vector.h"

#include <array>

namespace fenestra::core {

/// Normal vision, and dichromacy: no working L, M or S cones.
enum class ColorVision { normal, protan, deutan, tritan };
inline constexpr std::array colorVisions = {ColorVision::normal, ColorVision::protan,
                                            ColorVision::deutan, ColorVision::tritan};

/// Simulates color-deficient vision: returns the linear Rec. 709 color that looks to normal vision
/// as `linear` does to `vision`. Machado, Oliveira, Fernandes 2009 ("A Physiologically-based Model
/// for Simulation of Color Vision Deficiency"), severity 1. Clamped to [0, 1].
Rgb simulateVision(ColorVision vision, const Rgb& linear);

/// CIELAB, D65, 2-degree observer.
struct Lab {
  double L, a, b;
};

/// CIELAB of linear Rec. 709, where 1 is the display's white.
Lab toLab(const Rgb& linear);
/// Inverse of toLab; outside [0, 1] for colors that the display cannot show.
Rgb toLinear(const Lab& lab);

/// CIE 1976 color difference: the distance in CIELAB.
double deltaE76(const Lab& x, const Lab& y);
/// CIEDE2000 (Sharma, Wu, Dalal 2005, eq. 2 to 22), k_L = k_C = k_H = 1.
double deltaE2000(const Lab& x, const Lab& y);

} // namespace fenestra::core
