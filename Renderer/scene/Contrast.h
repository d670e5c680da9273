#pragma once
// Contrast of the focus with what surrounds it: arithmetic on two colours, before anything is
// rendered, and thus the same for every camera, clip and number of samples.

#include "image/ColorVision.h"
#include "scene/FocusInterface.h"

#include <algorithm>
#include <optional>
#include <string>

namespace fenestra {

/// Differences of the colours in which the focus and its surroundings are shown.
struct Contrast {
  std::array<double, 4> deltaE; ///< by ColorVision
  double deltaL;                ///< of CIELAB lightness, in absolute value

  /// Least share of what normal sight and the two frequent kinds of colour blindness need, 20, 12
  /// and 12, to tell them apart.
  double score() const;
  /// Least difference for the two frequent kinds of colour blindness.
  double colorBlind() const { return std::min(deltaE[1], deltaE[2]); }
};

/// Contrast of two colours as displayed, linear. `difference`: of two colours in CIELAB.
Contrast measureContrast(const Rgb& focus, const Rgb& context,
                         double (*difference)(const Lab&, const Lab&));

/// Contrast (CIEDE2000) of two colours that an eye sees of thick matter in white light, linear: lit
/// a little above white (radiance 1.1), by the film curve.
Contrast measureReflectedContrast(const Rgb& focus, const Rgb& context);

/// Contrast of the mean colours of both sides, which have at least one scalar each. `saturation`:
/// of the context (ContextStyle).
Contrast measureInterfaceContrast(const InterfaceScalars& interface,
                                  const TransferFunction& transfer, double saturation);

/// Context's saturation, and the contrast that it gives.
struct FocusContrast {
  double saturation = 1.0;
  std::optional<Contrast> contrast = {}; ///< nothing where one side is transparent
};

/// Saturations of a context that would hide the focus: tissue keeps its hue, or nothing does.
inline constexpr double mutedSaturation = 0.35, graySaturation = 0.0;

/// `asked`: by the user; nothing: the first of 1, `pale` and `grey` with which the contrast's share
/// exceeds 1; where none does, that of the greatest share, among equals the most colourful. `grey`
/// goes beyond the plan, which ended with `pale`: a brain in a head then differed by 8 across its
/// edge for the red-blind, who need 12.
FocusContrast chooseSaturation(const std::optional<double>& requested, const Mask& focus,
                               const Volume& volume, const TransferFunction& transfer);

/// Contrast and what it took, in a few words; empty: none.
std::string summary(const FocusContrast& contrast);

} // namespace fenestra
