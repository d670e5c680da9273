#pragma once
// Color contrast between the focus and its surroundings. It is computed from two colors before
// rendering, so it does not depend on camera, clip or number of samples.

#include "image/ColorVision.h"
#include "scene/FocusInterface.h"

#include <algorithm>
#include <optional>
#include <string>

namespace fenestra::core {

/// Differences between the displayed colors of the focus and of its surroundings.
struct Contrast {
  std::array<double, 4> deltaE; ///< indexed by ColorVision
  double deltaL;                ///< absolute difference of CIELAB lightness

  /// Smaller deltaE of the two common kinds of color blindness.
  double colorBlind() const { return std::min(deltaE[1], deltaE[2]); }
};

/// Contrast of two linear display colors. `difference`: color difference formula in CIELAB.
Contrast measureContrast(const Rgb& focus, const Rgb& context,
                         double (*difference)(const Lab&, const Lab&));

/// CIEDE2000 contrast of two linear reflectances of thick media. They are lit slightly above white
/// (radiance 1.1) and displayed with the film tone curve.
Contrast measureReflectedContrast(const Rgb& focus, const Rgb& context);

/// Contrast of the mean colors of both sides; each side needs at least one scalar. `saturation`:
/// of the context (ContextStyle).
Contrast measureInterfaceContrast(const InterfaceScalars& interface,
                                  const TransferFunction& transfer, double saturation);

/// Saturation of the context, and its contrast to the focus.
struct FocusContrast {
  double saturation = 1.0;
  std::optional<Contrast> contrast = {}; ///< empty if one side is transparent
};

/// Saturation of the context unless one is given: the focus stands out, and the surroundings still
/// have the colors of tissue.
inline constexpr double defaultContextSaturation = 0.75;

/// Contrast between the focus and a context of that saturation.
FocusContrast measureFocusContrast(double saturation, const Mask& focus, const Volume& volume,
                                   const TransferFunction& transfer);

/// "contrast of …": one line on contrast and saturation; empty without a contrast.
std::string summary(const FocusContrast& contrast);

} // namespace fenestra::core
