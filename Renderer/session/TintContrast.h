#pragma once
// Contrast of a tinted focus with its neighbours, made sure of by arithmetic on colours before
// anything is rendered: the same for every camera, clip and number of samples.

#include "session/Contrast.h"
#include "session/SegmentTint.h"

#include <optional>
#include <string>
#include <vector>

namespace fenestra {

/// Change of the colours that an eye sees of thick matter, in CIELAB.
struct ContrastKnobs {
  double contextSaturation = 1.0; ///< factor of the context's chroma
  double contextLightness = 0.0;  ///< share of the way to the lightness `contextGoal`
  double contextGoal = 72.0;      ///< bright, so that a cut through the context stays readable
  double focusChroma = 1.0;       ///< factor
  double focusLightness = 0.0;    ///< added to L*

  bool operator==(const ContrastKnobs&) const = default;
};

/// Colour changed by the knobs; linear, in the display's gamut and no whiter than matter can be.
Rgb changedContext(const Rgb& seen, const ContrastKnobs& knobs);
Rgb changedFocus(const Rgb& seen, const ContrastKnobs& knobs);

/// Colours to both sides of a part of the focus's border, as an eye sees them, linear.
struct BorderColors {
  Rgb focus, context;
  double area; ///< of the border, any unit
};

/// Share of what is wanted between two colours, 0 to 1, the mean of four: 16 for normal sight, 13
/// for each of both frequent kinds of colour blindness (CIEDE2000), and 15 of lightness, which
/// survives a grey print. With these, pictures have 20, 12, 12 and 8 in CIELAB across the edge,
/// mostly in deeper shadow than contrastUnder() knows of (Testing/Benchmarks/look.sh).
double tintShare(const Contrast& contrast);
/// Share beyond which no knob is turned: nobody sees what is missing.
inline constexpr double enoughShare = 0.98;

/// Contrast under the knobs, of both colours as pictures show them: partly in shadow, and under
/// what a wet surface reflects. `saturation`: of the context's albedo, after the knobs
/// (ContextStyle).
Contrast contrastUnder(const ContrastKnobs& knobs, const BorderColors& colors, double saturation,
                       double g);

/// Knobs with which the border has enoughShare, as the mean over its area. They are turned one
/// after the other, in their order, each no further than that needs, or, where that is out of its
/// reach, to where the share is greatest. `context`: what it sets is not turned. `isAutomatic`:
/// false: nothing is. `colors`: without any, nothing is, either.
ContrastKnobs chosenKnobs(const std::vector<BorderColors>& colors, const ContextColors& context,
                          bool isAutomatic, double saturation, double g);

struct TintContrast {
  ContrastKnobs knobs = {};
  std::string segment = {}, neighbour = {}; ///< of the part with the least share
  std::optional<Contrast> contrast = {};    ///< there; nothing: no neighbour is shown
};

/// Knobs for neighbours that have 5 % of the border or more. `saturation`: of the context's albedo.
TintContrast tintContrast(const std::vector<ComponentBorder>& borders, const TintPlan& plan,
                          const Tint& tint, const MaterialTable& table,
                          const TransferFunction& transfer, double saturation);

/// Contrast and what it took, in a few words; empty: none.
std::string told(const TintContrast& contrast);

/// Tint with the knobs.
Tint contrastedTint(const Tint& tint, const TintPlan& plan, const ContrastKnobs& knobs,
                    const TransferFunction& transfer);

} // namespace fenestra
