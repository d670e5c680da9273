#include "scene/TintContrast.h"

#include "base/Color.h"
#include "base/Text.h"
#include "io/MessageText.h"
#include "model/medium/Reflectance.h"

#include <algorithm>
#include <utility>

namespace fenestra::core {
namespace {

Lab accentLab(std::size_t accent) {
  return toLab(decodeSrgb(hexToRgb(accentColors[accent].color)));
}

bool isInGamut(const Rgb& color) {
  return color.minCoeff() >= 0.0 && color.maxCoeff() <= maxReflectance;
}

/// Linear color; chroma is reduced as far as the display gamut requires.
Rgb reduceToGamut(const Lab& lab) {
  constexpr int bisections = 20;
  const auto withChroma = [&](double fraction) {
    return toLinear({lab.L, fraction * lab.a, fraction * lab.b});
  };
  double low = 0.0, high = 1.0;
  if (isInGamut(withChroma(high)))
    return withChroma(high);
  for (int i = 0; i < bisections; ++i) {
    const double middle = 0.5 * (low + high);
    (isInGamut(withChroma(middle)) ? low : high) = middle;
  }
  return withChroma(low).max(0.0).min(maxReflectance);
}

// Colors at the edge of the focus in an image: least squares over the mean colors 3 to 8 pixels
// from the edges of foci (abdomen, torso, knee; twenty images of eleven foci; appearance.sh prints
// them) with the lights of an operating theater, a wet coat, contrast colors and the film tone
// curve. The lightness of the focus deviates from the fit by 2, that of the context by 5 (standard
// deviation).

/// Factor of the focus's chroma: the brighter, the more of it the tone curve removes.
double toImageSaturation(double L) {
  return 1.33 - 0.0074 * L;
}

/// Difference of the context's L* from the fit: in a groove, typical, and facing the lights.
constexpr std::array contextShading = {-6.0, 0.0, 6.0};

/// Linear color of the focus, as it appears in an image. The tone curve compresses highlights.
Rgb toImageFocus(const Rgb& reflectance) {
  const Lab lab = toLab(reflectance);
  const double saturation = toImageSaturation(lab.L);
  return toLinear({16.0 + (1.1 - 0.0038 * lab.L) * lab.L, saturation * lab.a, saturation * lab.b})
      .max(0.0)
      .min(1.0);
}

/// Linear color of the context, as it appears in an image. Its colors are mixtures of more tissues
/// than the interface has.
Rgb toImageContext(const Rgb& reflectance, double shading) {
  const Lab lab = toLab(reflectance);
  return toLinear({51.0 + 0.26 * lab.L + shading, lab.a, lab.b}).max(0.0).min(1.0);
}

/// Contrasts of the adjusted colors for each contextShading.
auto predictContrasts(const ColorAdjustment& adjustment, const InterfaceColors& colors) {
  const Rgb focus = toImageFocus(adjustFocus(colors.focus, adjustment)),
            context = adjustContext(colors.context, adjustment);
  std::array<Contrast, contextShading.size()> contrasts;
  std::ranges::transform(contextShading, contrasts.begin(), [&](double shading) {
    return measureContrast(focus, toImageContext(context, shading), deltaE76);
  });
  return contrasts;
}

/// Albedo of a component as a function of the scalar.
const ColorFunction& albedoOf(const std::optional<ColorFunction>& own,
                              const TransferFunction& transfer) {
  return own ? *own : transfer.albedo;
}

/// Finds the adjustment of an interface with the best contrast.
class AdjustmentSearch {
public:
  AdjustmentSearch(const std::vector<InterfaceColors>& colors, const ColorAdjustment& start)
      : m_colors(&colors), m_adjustment(start), m_score(computeScore(start)) {}

  const ColorAdjustment& adjustment() const { return m_adjustment; }

  /// Reduces the context's saturation in steps to at least `limit`, to the first value with a
  /// sufficient score, or the one with the best.
  void reduceSaturation(double limit) {
    constexpr int steps = 20;
    constexpr double leastGain = 1e-6; // above rounding errors, as of a gray context
    ColorAdjustment candidate = m_adjustment;
    const double first = candidate.contextSaturation;
    for (int i = 1; i <= steps && m_score < sufficientScore; ++i) {
      candidate.contextSaturation = first + (limit - first) * i / steps;
      if (const double score = computeScore(candidate); score > m_score + leastGain) {
        m_adjustment = candidate;
        m_score = score;
      }
    }
  }

  /// Makes the focus darker or lighter and blends it with an accent color: of the changes with a
  /// sufficient score, or else the best, the one with the least accent, then the smallest shift.
  /// Only accents of similar lightness are tried: a pale organ in dark red would look like muscle.
  /// White foci become only darker, and more so: bright colors lose their hue in an image.
  void changeFocus() {
    constexpr double maxDifference = 30.0, blendStep = 0.1, shiftStep = 3.0, white = 80.0;
    constexpr int maxBlend = 6, maxShift = 12, maxWhiteShift = 16; // in steps
    const double own = mean([](const InterfaceColors& part) { return toLab(part.focus).L; });
    const int first = own < white ? -maxShift : -maxWhiteShift, last = own < white ? maxShift : 0;
    ColorAdjustment candidate = m_adjustment;
    for (int blend = 0; blend <= maxBlend && m_score < sufficientScore; ++blend)
      for (std::size_t accent = 0; accent < (blend > 0 ? accentColors.size() : 1); ++accent) {
        candidate.accent = accent;
        candidate.focusAccent = blendStep * blend;
        if (blend > 0 && std::abs(accentLab(accent).L - own) > maxDifference)
          continue;
        for (int shift = first; shift <= last; ++shift) {
          candidate.focusLightness = shiftStep * shift;
          tryCandidate(candidate);
        }
      }
  }

private:
  void tryCandidate(const ColorAdjustment& candidate) {
    const double score = std::min(computeScore(candidate), sufficientScore);
    const bool isSmaller =
        std::abs(candidate.focusLightness) < std::abs(m_adjustment.focusLightness) &&
        candidate.focusAccent == m_adjustment.focusAccent;
    if (score > m_score || (score == m_score && isSmaller)) {
      m_adjustment = candidate;
      m_score = score;
    }
  }
  /// Mean of a function over the interface, weighted by area.
  double mean(const auto& function) const {
    double sum = 0.0, area = 0.0;
    for (const InterfaceColors& part : *m_colors) {
      sum += part.area * function(part);
      area += part.area;
    }
    return sum / area;
  }
  double computeScore(const ColorAdjustment& adjustment) const {
    return mean([&](const InterfaceColors& part) {
      double sum = 0.0;
      for (const Contrast& contrast : predictContrasts(adjustment, part))
        sum += contrastScore(contrast);
      return sum / contextShading.size();
    });
  }

  const std::vector<InterfaceColors>* m_colors;
  ColorAdjustment m_adjustment;
  double m_score;
};

/// Parts with a significant fraction of the interface.
std::vector<ComponentInterface> selectMajor(std::vector<ComponentInterface> interfaces) {
  constexpr double minFraction = 0.05;
  double area = 0.0;
  for (const ComponentInterface& part : interfaces)
    area += part.area;
  std::erase_if(interfaces, [&](const auto& part) { return part.area < minFraction * area; });
  return interfaces;
}

} // namespace

Rgb adjustContext(const Rgb& reflectance, const ColorAdjustment& adjustment) {
  constexpr double white = 100.0;
  const Lab lab = toLab(reflectance);
  return reduceToGamut({lab.L + adjustment.contextLightness * (white - lab.L),
                        adjustment.contextSaturation * lab.a,
                        adjustment.contextSaturation * lab.b});
}

Rgb adjustFocus(const Rgb& reflectance, const ColorAdjustment& adjustment) {
  constexpr double maxChroma = 45.0;
  const Lab lab = toLab(reflectance), accent = accentLab(adjustment.accent);
  const auto mix = [&](double own, double other) {
    return own + adjustment.focusAccent * (other - own);
  };
  const Lab mixed{mix(lab.L + adjustment.focusLightness, accent.L), mix(lab.a, accent.a),
                  mix(lab.b, accent.b)};
  const auto imageChroma = [](const Lab& color) {
    return toImageSaturation(color.L) * std::hypot(color.a, color.b);
  };
  const double chroma = imageChroma(mixed), limit = std::max(maxChroma, imageChroma(lab));
  const double factor = chroma > limit ? limit / chroma : 1.0;
  return reduceToGamut({mixed.L, factor * mixed.a, factor * mixed.b});
}

double contrastScore(const Contrast& contrast) {
  constexpr double normal = 25.0, colorBlind = 15.0, lightness = 10.0;
  return 0.25 * (std::min(1.0, contrast.deltaE[0] / normal) +
                 std::min(1.0, contrast.deltaE[1] / colorBlind) +
                 std::min(1.0, contrast.deltaE[2] / colorBlind) +
                 std::min(1.0, contrast.deltaL / lightness));
}

Contrast measureAdjustedContrast(const ColorAdjustment& adjustment, const InterfaceColors& colors) {
  return std::ranges::min(predictContrasts(adjustment, colors), {}, contrastScore);
}

ColorAdjustment chooseAdjustment(const std::vector<InterfaceColors>& colors,
                                 const ContextColors& context, Adjustable adjustable) {
  constexpr double minSaturation = 0.4;
  const bool isFocusAdjustable = adjustable == Adjustable::both;
  ColorAdjustment start{.contextSaturation = context.saturation.value_or(1.0),
                        .contextLightness = context.lightness.value_or(0.0)};
  if (adjustable == Adjustable::nothing || colors.empty())
    return start;
  if (!context.saturation && isFocusAdjustable)
    start.contextSaturation = defaultContextSaturation;
  AdjustmentSearch search(colors, start);
  if (!context.saturation)
    search.reduceSaturation(isFocusAdjustable ? minSaturation : 0.0);
  if (isFocusAdjustable)
    search.changeFocus();
  return search.adjustment();
}

TintContrast adjustContrast(const std::vector<ComponentInterface>& interfaces, const TintPlan& plan,
                            const Tint& tint, const MaterialTable& table,
                            const TransferFunction& transfer) {
  const auto reflected = [&](std::uint8_t component, double scalar) {
    return toReflectance(Rgb(albedoOf(tint.albedo[component], transfer)(scalar)), transfer.g);
  };
  const std::vector<ComponentInterface> parts = selectMajor(interfaces);
  std::vector<InterfaceColors> colors;
  for (const ComponentInterface& part : parts)
    colors.push_back({reflected(part.focus, part.focusScalar),
                      reflected(part.context, part.contextScalar), part.area});
  const bool isKnown = std::ranges::any_of(
      parts, [&](const ComponentInterface& part) { return tint.albedo[part.focus].has_value(); });
  const Adjustable adjustable = !table.hasContrast ? Adjustable::nothing
                                : isKnown          ? Adjustable::both
                                                   : Adjustable::context;
  TintContrast result{.adjustment = chooseAdjustment(colors, table.context, adjustable)};
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const Contrast contrast = measureAdjustedContrast(result.adjustment, colors[i]);
    if (result.contrast && contrastScore(contrast) >= contrastScore(*result.contrast))
      continue;
    result.contrast = contrast;
    result.segment = plan.names[parts[i].focus];
    result.neighbor = plan.names[parts[i].context];
  }
  return result;
}

std::string summary(const TintContrast& chosen) {
  if (!chosen.contrast)
    return "";
  const Contrast& contrast = *chosen.contrast;
  const ColorAdjustment &adjustment = chosen.adjustment, neutral;
  std::string text = concat("contrast of ", sanitize(chosen.segment), " vs ",
                            sanitize(chosen.neighbor), ": dE ", toString(contrast.deltaE[0], 3),
                            " (color-blind ", toString(contrast.colorBlind(), 3), ")");
  const auto add = [&](const std::string& what, double ColorAdjustment::*member) {
    if (adjustment.*member != neutral.*member)
      text += concat("; ", what, " ", toString(std::abs(adjustment.*member), 3));
  };
  add("surroundings' saturation times", &ColorAdjustment::contextSaturation);
  add("surroundings lightened by", &ColorAdjustment::contextLightness);
  add(adjustment.focusLightness < 0.0 ? "focus darkened by" : "focus lightened by",
      &ColorAdjustment::focusLightness);
  add(concat("focus blended with ", accentColors[adjustment.accent].name, " by"),
      &ColorAdjustment::focusAccent);
  return text;
}

Tint applyAdjustment(const Tint& tint, const TintPlan& plan, const ColorAdjustment& adjustment,
                     const TransferFunction& transfer) {
  Tint result = tint;
  if (adjustment == ColorAdjustment())
    return result;
  for (std::size_t i = 0; i < result.albedo.size(); ++i) {
    const auto adjust = plan.isFocus[i] ? adjustFocus : adjustContext;
    result.albedo[i] = albedoOf(tint.albedo[i], transfer).withKnots([&](ColorFunction::Knot& knot) {
      knot.value =
          toAlbedo(adjust(toReflectance(Rgb(knot.value), transfer.g), adjustment), transfer.g);
    });
  }
  return result;
}

} // namespace fenestra::core
