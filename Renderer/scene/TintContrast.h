#pragma once
// Contrast of a tinted focus with its neighbours, made sure of by arithmetic on colours before
// anything is rendered: the same for every camera, clip and number of samples.

#include "scene/Contrast.h"
#include "scene/SegmentTint.h"

#include <optional>
#include <string>
#include <vector>

namespace fenestra {

/// Change of the colours that an eye sees of thick matter, in CIELAB.
struct ColorAdjustment {
  double contextSaturation = 1.0; ///< factor of the context's chroma
  double contextLightness = 0.0;  ///< share of the way to the lightness `contextGoal`
  double contextGoal = 72.0;
  double focusLightness = 0.0; ///< added to L*
  double focusChroma = 1.0;    ///< factor
  double focusAccent = 0.0;    ///< share of the way to the colour `accent`
  std::size_t accent = 0;      ///< of `accents`

  bool operator==(const ColorAdjustment&) const = default;
};

/// Colours far from each other in CIELAB, for the colour-blind, too.
struct AccentColor {
  const char* name;
  std::uint32_t color; ///< sRGB, 0xrrggbb
};
inline constexpr std::array accentColors = {AccentColor{"yellow", 0xebbe3c},
                                            AccentColor{"ice", 0xbfe6f2},
                                            AccentColor{"dark red", 0x7c1e22}};

/// Colour changed by the knobs; linear, no whiter than matter can be, and, where the display has no
/// such colour, of less chroma.
Rgb adjustContext(const Rgb& seen, const ColorAdjustment& adjustment);
Rgb adjustFocus(const Rgb& seen, const ColorAdjustment& adjustment);

/// Colours to both sides of a part of the focus's border, as an eye sees them, linear.
struct InterfaceColors {
  Rgb focus, context;
  double area; ///< of the border, any unit
};

/// Share of what is wanted across an edge in a picture, 0 to 1, the mean of four: of a difference
/// (CIELAB) of 20 for normal sight, of 12 for each of both frequent kinds of colour blindness, and
/// of 8 in lightness, which survives a grey print; each and a tenth, since
/// measureAdjustedContrast() is not exact.
double contrastScore(const Contrast& contrast);
/// Share beyond which no knob is turned: nobody sees what is missing.
inline constexpr double sufficientScore = 0.995;
/// Share below which knobs are turned beyond what tissue looks like: a difference of 19 of 22.
inline constexpr double nearlySufficient = 0.966;

/// Contrast (CIELAB) under the knobs across the focus's edge in a picture: in the light, or, if
/// that is less, where the focus stands in a groove that it shades. `saturation`: of the context's
/// albedo, after the knobs (ContextStyle).
Contrast measureAdjustedContrast(const ColorAdjustment& adjustment, const InterfaceColors& colors,
                                 double saturation, double g);

/// Knobs that may be turned. `context`: of a focus of which nothing is known, so that it keeps the
/// volume's colours.
enum class Adjustable { nothing, context, both };

/// Knobs with which the border has sufficientScore, as the mean over its area, from a context of
/// 0.6 of its saturation on: muted, it takes fewer collisions, too. They are turned one after the
/// other, in their order, each no further than that needs, or, where that is out of its reach, to
/// where the share is greatest; then, from the last to the first, back as far as nothing is lost.
/// Where even nearlySufficient is out of reach they begin at the whole saturation, and go farther,
/// on the same way. Of a darker focus in a lighter context and the reverse, the way whose share is
/// more worth its change of colours. `context`: what it sets is not turned. `colors`: without any,
/// nothing is, either. Where the focus is not turned, its context may become grey.
ColorAdjustment chooseAdjustment(const std::vector<InterfaceColors>& colors,
                                 const ContextColors& context, Adjustable adjustable,
                                 double saturation, double g);

struct TintContrast {
  ColorAdjustment adjustment = {};
  std::string segment = {}, neighbor = {}; ///< of the part with the least share
  std::optional<Contrast> contrast = {};   ///< there; nothing: no neighbour is shown
};

/// Knobs for neighbours that have 5 % of the border or more. `saturation`: of the context's albedo.
TintContrast adjustContrast(const std::vector<ComponentInterface>& interfaces, const TintPlan& plan,
                            const Tint& tint, const MaterialTable& table,
                            const TransferFunction& transfer, double saturation);

/// Contrast and what it took, in a few words; empty: none.
std::string summary(const TintContrast& contrast);

/// Tint with the knobs.
Tint applyAdjustment(const Tint& tint, const TintPlan& plan, const ColorAdjustment& adjustment,
                     const TransferFunction& transfer);

} // namespace fenestra
