#pragma once
// Contrast adjustment of a tinted focus. The colors on both sides of the focus interface are
// changed step by step until they are distinguishable. The computation models the typical effect of
// shading on colors and ignores the view, so all frames of a turntable get the same colors.

#include "scene/Contrast.h"
#include "scene/SegmentTint.h"

#include <optional>
#include <string>
#include <vector>

namespace fenestra::core {

/// Change of the reflected colors of thick media, in CIELAB.
struct ColorAdjustment {
  double contextSaturation = 1.0; ///< factor of the context's chroma
  double contextLightness = 0.0;  ///< blend weight toward white
  double focusLightness = 0.0;    ///< shift of L*
  double focusAccent = 0.0;       ///< blend weight toward the color `accent`
  std::size_t accent = 0;         ///< index in `accentColors`

  bool operator==(const ColorAdjustment&) const = default;
};

/// Colors that differ strongly in CIELAB, also for color-blind viewers.
struct AccentColor {
  const char* name;
  std::uint32_t color; ///< sRGB, 0xrrggbb
};
inline constexpr std::array accentColors = {
    AccentColor{"yellow", 0xe3bf71}, AccentColor{"ice", 0xbfe6f2}, AccentColor{"blue", 0x5b93d6},
    AccentColor{"dark red", 0x712223}};

/// Applies the adjustment to a linear reflected color. The result is at most maxReflectance; its
/// chroma is reduced where it would leave the display gamut. The focus's chroma in an image does
/// not rise above 45.
Rgb adjustContext(const Rgb& reflectance, const ColorAdjustment& adjustment);
Rgb adjustFocus(const Rgb& reflectance, const ColorAdjustment& adjustment);

/// Reflected colors on both sides of a part of the focus interface, linear.
struct InterfaceColors {
  Rgb focus, context;
  double area; ///< of the interface, any unit
};

/// Contrast relative to the target, 0 to 1. It is the mean of four ratios, each at most 1. The
/// targets are a CIELAB difference of 20 for normal vision, 12 for each of the two common kinds of
/// color blindness, and 8 in lightness, which survives grayscale printing. Each target is raised by
/// a quarter, since measureAdjustedContrast() is approximate.
double contrastScore(const Contrast& contrast);
/// The search stops at this score: the remaining difference is invisible.
inline constexpr double sufficientScore = 0.999;

/// CIELAB contrast of the adjusted colors across the focus edge in an image: the least of the
/// contrasts with a context that is darker than typical, typical, and lighter.
Contrast measureAdjustedContrast(const ColorAdjustment& adjustment, const InterfaceColors& colors);

/// Which colors may be adjusted. `context`: if the focus has no known material, so that it keeps
/// the volume's colors.
enum class Adjustable { nothing, context, both };

/// Finds the adjustment whose score reaches sufficientScore, or the best within the limits. The
/// score is the mean over the interface area, and over a darker, a typical and a lighter context.
/// In this order, each only as far as needed: the context's saturation falls from the library's to
/// 0.4; the focus becomes darker or lighter by at most 36, or, if it is white, darker by at most
/// 48; it is blended with an accent color by at most 0.6. `context`: members that it sets stay
/// fixed. If the focus is not adjustable, the context may become gray. Without `colors`, nothing is
/// adjusted.
ColorAdjustment chooseAdjustment(const std::vector<InterfaceColors>& colors,
                                 const ContextColors& context, Adjustable adjustable);

struct TintContrast {
  ColorAdjustment adjustment = {};
  std::string segment = {}, neighbor = {}; ///< of the interface with the lowest score
  std::optional<Contrast> contrast = {};   ///< at this interface; empty: no visible neighbor
};

/// Uses neighbors with at least 5 % of the interface.
TintContrast adjustContrast(const std::vector<ComponentInterface>& interfaces, const TintPlan& plan,
                            const Tint& tint, const MaterialTable& table,
                            const TransferFunction& transfer);

/// "contrast of …": one line on contrast and adjustment; empty without a contrast.
std::string summary(const TintContrast& contrast);

/// The tint with adjusted colors.
Tint applyAdjustment(const Tint& tint, const TintPlan& plan, const ColorAdjustment& adjustment,
                     const TransferFunction& transfer);

} // namespace fenestra::core
