#include "scene/TintContrast.h"

#include "base/Color.h"
#include "base/Text.h"
#include "io/MessageText.h"
#include "model/medium/ContextStyle.h"
#include "model/medium/Reflectance.h"

#include <algorithm>
#include <functional>

namespace fenestra {
namespace {

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

/// Decrease of L* of the context at the edge: where it faces the light, and in a groove that the
/// focus shades. These values and those in toImageColor() were fitted by hand to mean colors 3 to 8
/// pixels from the edges of seven foci (abdomen, knee, torso; AppearanceBenchmark) with the cinema
/// lights and the film tone curve.
constexpr std::array contextShading = {-3.0, 4.0};

/// Linear color of a medium at the edge, as it appears in an image. Shadows and specular
/// reflections leave less than half of the lightness differences.
Rgb toImageColor(const Rgb& reflectance, double shade) {
  constexpr double darkest = 29.0, lightness = 0.43, saturation = 0.62;
  const Lab lab = toLab(reflectance);
  const double L = darkest + lightness * lab.L, chroma = saturation * L / std::max(lab.L, 1.0);
  return toLinear({L - shade, chroma * lab.a, chroma * lab.b}).max(0.0).min(1.0);
}

/// Albedo of a component as a function of the scalar.
const ColorFunction& albedoOf(const std::optional<ColorFunction>& own,
                              const TransferFunction& transfer) {
  return own ? *own : transfer.albedo;
}

/// Saturation of the context at the start, limits of the adjustment, and the CIELAB color
/// difference whose cost equals a score of 1.
struct Limits {
  double saturationStart;
  double saturation, lightness, shift, chroma, accent;
  double changeScale;
};
/// `gentle` stays within tissue colors. `strong` leaves them, for a focus in similar tissue (bowel
/// in bowel, one vertebra on another).
constexpr Limits gentle{0.6, 0.5, 0.35, 12.0, 1.4, 0.35, 300.0},
    strong{1.0, 0.3, 0.5, 18.0, 1.7, 0.6, 600.0};

/// Increases the adjustment until the interface has enough contrast.
class AdjustmentSearch {
public:
  AdjustmentSearch(const std::vector<InterfaceColors>& colors, const ColorAdjustment& start,
                   double changeScale, double saturation, double g)
      : m_colors(&colors),
        m_changeScale(changeScale),
        m_saturation(saturation),
        m_g(g),
        m_start(start),
        m_adjustment(start),
        m_score(computeScore(start)) {}

  const ColorAdjustment& adjustment() const { return m_adjustment; }
  double score() const { return m_score; }

  /// Increases a member in steps, from its current value to at most `limit`.
  void increase(double ColorAdjustment::*member, double limit) {
    const double first = m_adjustment.*member;
    for (int i = 1; i <= steps && m_score < sufficientScore; ++i)
      tryValue(member, first + (limit - first) * i / steps,
               [this](double score) { return score > m_score; });
  }

  /// Moves all members back toward the start, last to first, as long as the score stays sufficient.
  /// Repeats this, since one relaxed member may allow another to relax further.
  void relax() {
    ColorAdjustment before;
    do {
      before = m_adjustment;
      for (const auto member :
           {&ColorAdjustment::focusAccent, &ColorAdjustment::focusChroma,
            &ColorAdjustment::focusLightness, &ColorAdjustment::contextLightness,
            &ColorAdjustment::contextSaturation})
        relax(member);
    } while (!(m_adjustment == before));
  }

  /// Blends the focus with the best accent color, if one improves the net score. Only accents of
  /// similar lightness are tried: a pale organ in dark red would look like muscle.
  void addAccent(double limit) {
    constexpr double maxDifference = 40.0;
    const double own = mean([](const InterfaceColors& part) { return toLab(part.focus).L; });
    AdjustmentSearch best = *this;
    for (std::size_t i = 0; i < accentColors.size() && m_score < sufficientScore; ++i) {
      if (std::abs(toLab(decodeSrgb(hexToRgb(accentColors[i].color))).L - own) > maxDifference)
        continue;
      AdjustmentSearch candidate = *this;
      candidate.m_adjustment.accent = i;
      candidate.increase(&ColorAdjustment::focusAccent, limit);
      if (candidate.isBetterThan(best))
        best = candidate;
    }
    m_adjustment = best.m_adjustment;
    m_score = best.m_score;
  }

  /// True if its score, less the cost of its color change, is higher.
  bool isBetterThan(const AdjustmentSearch& other) const { return netScore() > other.netScore(); }

private:
  static constexpr int steps = 20;

  void relax(double ColorAdjustment::*member) {
    const double last = m_adjustment.*member, needed = std::min(m_score, sufficientScore);
    for (int i = 1; i <= steps; ++i)
      if (!tryValue(member, last + (m_start.*member - last) * i / steps,
                    [needed](double score) { return score >= needed; }))
        return;
  }

  bool tryValue(double ColorAdjustment::*member, double value, const auto& accept) {
    ColorAdjustment candidate = m_adjustment;
    candidate.*member = value;
    const double score = computeScore(candidate);
    if (!accept(score))
      return false;
    m_adjustment = candidate;
    m_score = score;
    return true;
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
      return contrastScore(measureAdjustedContrast(adjustment, part, m_saturation, m_g));
    });
  }
  double netScore() const { return std::min(m_score, sufficientScore) - change() / m_changeScale; }
  /// Mean color difference from the original colors, summed over both sides.
  double change() const {
    return mean([&](const InterfaceColors& part) {
      return deltaE76(toLab(part.focus), toLab(adjustFocus(part.focus, m_adjustment))) +
             deltaE76(toLab(part.context), toLab(adjustContext(part.context, m_adjustment)));
    });
  }

  const std::vector<InterfaceColors>* m_colors;
  double m_changeScale, m_saturation, m_g;
  ColorAdjustment m_start, m_adjustment;
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
  const Lab lab = toLab(reflectance);
  return reduceToGamut({lab.L + adjustment.contextLightness * (adjustment.contextGoal - lab.L),
                        adjustment.contextSaturation * lab.a,
                        adjustment.contextSaturation * lab.b});
}

Rgb adjustFocus(const Rgb& reflectance, const ColorAdjustment& adjustment) {
  const Lab lab = toLab(reflectance),
            accent = toLab(decodeSrgb(hexToRgb(accentColors[adjustment.accent].color)));
  const auto mix = [&](double own, double other) {
    return own + adjustment.focusAccent * (other - own);
  };
  return reduceToGamut({mix(lab.L + adjustment.focusLightness, accent.L),
                        mix(adjustment.focusChroma * lab.a, accent.a),
                        mix(adjustment.focusChroma * lab.b, accent.b)});
}

double contrastScore(const Contrast& contrast) {
  constexpr double normal = 22.0, colorBlind = 13.2, lightness = 8.8;
  return 0.25 * (std::min(1.0, contrast.deltaE[0] / normal) +
                 std::min(1.0, contrast.deltaE[1] / colorBlind) +
                 std::min(1.0, contrast.deltaE[2] / colorBlind) +
                 std::min(1.0, contrast.deltaL / lightness));
}

Contrast measureAdjustedContrast(const ColorAdjustment& adjustment, const InterfaceColors& colors,
                                 double saturation, double g) {
  const ContextStyle style{.focus = nullptr, .saturation = saturation};
  const Rgb focus = adjustFocus(colors.focus, adjustment),
            context = toReflectance(
                Rgb(style.desaturate(toAlbedo(adjustContext(colors.context, adjustment), g))), g);
  const auto measure = [&](double shade) {
    return measureContrast(toImageColor(focus, 0.0), toImageColor(context, shade), deltaE76);
  };
  return std::min(
      measure(contextShading[0]), measure(contextShading[1]),
      [](const Contrast& x, const Contrast& y) { return contrastScore(x) < contrastScore(y); });
}

ColorAdjustment chooseAdjustment(const std::vector<InterfaceColors>& colors,
                                 const ContextColors& context, Adjustable adjustable,
                                 double saturation, double g) {
  constexpr double white = 100.0, bright = 72.0, dim = 40.0; // L* of the context
  ColorAdjustment start;
  start.contextSaturation = context.saturation.value_or(start.contextSaturation);
  if (context.lightness) {
    start.contextLightness = *context.lightness;
    start.contextGoal = white;
  }
  if (adjustable == Adjustable::nothing || colors.empty())
    return start;
  const auto search = [&](const Limits& limits, double shift, double goal) {
    if (!context.lightness)
      start.contextGoal = goal;
    if (!context.saturation && adjustable == Adjustable::both)
      start.contextSaturation = limits.saturationStart;
    AdjustmentSearch result(colors, start, limits.changeScale, saturation, g);
    if (!context.saturation)
      result.increase(&ColorAdjustment::contextSaturation,
                      adjustable == Adjustable::both ? limits.saturation : 0.0);
    if (!context.lightness)
      result.increase(&ColorAdjustment::contextLightness, limits.lightness);
    if (adjustable == Adjustable::both) {
      result.increase(&ColorAdjustment::focusLightness, shift);
      result.increase(&ColorAdjustment::focusChroma, limits.chroma);
      result.addAccent(limits.accent);
    }
    result.relax();
    return result;
  };
  // A darker focus in a bright context, and the reverse.
  const auto darker = [&](const Limits& limits) { return search(limits, -limits.shift, bright); };
  const auto lighter = [&](const Limits& limits) { return search(limits, limits.shift, dim); };
  const AdjustmentSearch dark = darker(gentle), light = lighter(gentle);
  const bool isLight = light.isBetterThan(dark);
  const AdjustmentSearch& tissue = isLight ? light : dark;
  if (tissue.score() >= nearlySufficient)
    return tissue.adjustment();
  return (isLight ? lighter(strong) : darker(strong)).adjustment();
}

TintContrast adjustContrast(const std::vector<ComponentInterface>& interfaces, const TintPlan& plan,
                            const Tint& tint, const MaterialTable& table,
                            const TransferFunction& transfer, double saturation) {
  const double g = transfer.g;
  const auto reflected = [&](std::uint8_t component, double scalar) {
    return toReflectance(Rgb(albedoOf(tint.albedo[component], transfer)(scalar)), g);
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
  TintContrast result{.adjustment =
                          chooseAdjustment(colors, table.context, adjustable, saturation, g)};
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const Contrast contrast = measureAdjustedContrast(result.adjustment, colors[i], saturation, g);
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
  add("surroundings' lightness evened by", &ColorAdjustment::contextLightness);
  add(adjustment.focusLightness < 0.0 ? "focus darkened by" : "focus lightened by",
      &ColorAdjustment::focusLightness);
  add("focus's saturation times", &ColorAdjustment::focusChroma);
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

} // namespace fenestra
