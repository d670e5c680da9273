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

/// Colour, linear, with as much of its chroma as the display has.
Rgb reduceToGamut(const Lab& lab) {
  constexpr int bisections = 20;
  const auto withChroma = [&](double fraction) {
    return toLinear({lab.L, fraction * lab.a, fraction * lab.b});
  };
  double least = 0.0, most = 1.0;
  if (isInGamut(withChroma(most)))
    return withChroma(most);
  for (int i = 0; i < bisections; ++i) {
    const double middle = 0.5 * (least + most);
    (isInGamut(withChroma(middle)) ? least : most) = middle;
  }
  return withChroma(least).max(0.0).min(maxReflectance);
}

/// Loss of L* of a context at the edge: where it faces the light, and in a groove
/// that the focus shades. With what pictured() says, chosen by eye for means from 3 to 8 pixels to
/// both sides of the edges of seven foci (abdomen, knee, torso; LookBenchmark) under cinema and the
/// film curve.
constexpr std::array contextShading = {-3.0, 4.0};

/// Colour, linear, that pictures show of matter at the edge: shadow and what wet surfaces reflect
/// leave less than half of the differences in lightness.
Rgb toImageColor(const Rgb& seen, double shade) {
  constexpr double darkest = 29.0, lightness = 0.43, saturation = 0.62;
  const Lab lab = toLab(seen);
  const double L = darkest + lightness * lab.L, chroma = saturation * L / std::max(lab.L, 1.0);
  return toLinear({L - shade, chroma * lab.a, chroma * lab.b}).max(0.0).min(1.0);
}

/// Albedo of a component over the scalar.
const ColorFunction& albedoOf(const std::optional<ColorFunction>& own,
                              const TransferFunction& transfer) {
  return own ? *own : transfer.albedo;
}

/// Context's saturation before any knob is turned, how far knobs may be turned, and the difference
/// of colours from their own that all of what is wanted would be worth.
struct Limits {
  double saturationStart;
  double saturation, lightness, shift, chroma, accent;
  double changeScale;
};
/// Tissue stays tissue; and, of a focus that would not be told from its like (bowel in bowel, a
/// vertebra on another), paint.
constexpr Limits gentle{0.6, 0.5, 0.35, 12.0, 1.4, 0.35, 300.0},
    strong{1.0, 0.3, 0.5, 18.0, 1.7, 0.6, 600.0};

/// Turns knobs until a border has enough of what is wanted.
class AdjustmentSearch {
public:
  AdjustmentSearch(const std::vector<InterfaceColors>& colors, const ColorAdjustment& start,
                   double worth, double saturation, double g)
      : m_colors(&colors),
        m_changeScale(worth),
        m_saturation(saturation),
        m_g(g),
        m_start(start),
        m_adjustment(start),
        m_score(computeScore(start)) {}

  const ColorAdjustment& adjustment() const { return m_adjustment; }
  double score() const { return m_score; }

  /// Turns a knob from where it is, in steps, to at most `farthest`.
  void increase(double ColorAdjustment::*knob, double farthest) {
    const double first = m_adjustment.*knob;
    for (int i = 1; i <= steps && m_score < sufficientScore; ++i)
      tryValue(knob, first + (farthest - first) * i / steps,
               [this](double fraction) { return fraction > m_score; });
  }

  /// Turns all knobs back toward the start, from the last to the first, as far as that costs
  /// nothing that is wanted: again as long as one that is back lets another follow.
  void relax() {
    ColorAdjustment before;
    do {
      before = m_adjustment;
      for (const auto knob : {&ColorAdjustment::focusAccent, &ColorAdjustment::focusChroma,
                              &ColorAdjustment::focusLightness, &ColorAdjustment::contextLightness,
                              &ColorAdjustment::contextSaturation})
        relax(knob);
    } while (!(m_adjustment == before));
  }

  /// Turns the focus toward the accent that is worth most, if one is worth the change, of those
  /// about as light as itself: a pale organ in dark red would be taken for muscle.
  void addAccent(double farthest) {
    constexpr double mostApart = 40.0;
    const double own = mean([](const InterfaceColors& part) { return toLab(part.focus).L; });
    AdjustmentSearch best = *this;
    for (std::size_t i = 0; i < accentColors.size() && m_score < sufficientScore; ++i) {
      if (std::abs(toLab(decodeSrgb(hexToRgb(accentColors[i].color))).L - own) > mostApart)
        continue;
      AdjustmentSearch turned = *this;
      turned.m_adjustment.accent = i;
      turned.increase(&ColorAdjustment::focusAccent, farthest);
      if (turned.isBetterThan(best))
        best = turned;
    }
    m_adjustment = best.m_adjustment;
    m_score = best.m_score;
  }

  /// True if its share is worth its change.
  bool isBetterThan(const AdjustmentSearch& other) const { return worth() > other.worth(); }

private:
  static constexpr int steps = 20;

  void relax(double ColorAdjustment::*knob) {
    const double last = m_adjustment.*knob, needed = std::min(m_score, sufficientScore);
    for (int i = 1; i <= steps; ++i)
      if (!tryValue(knob, last + (m_start.*knob - last) * i / steps,
                    [needed](double fraction) { return fraction >= needed; }))
        return;
  }

  bool tryValue(double ColorAdjustment::*knob, double value, const auto& isWanted) {
    ColorAdjustment turned = m_adjustment;
    turned.*knob = value;
    const double share = computeScore(turned);
    if (!isWanted(share))
      return false;
    m_adjustment = turned;
    m_score = share;
    return true;
  }

  /// Mean over the border of a function of its parts.
  double mean(const auto& function) const {
    double sum = 0.0, area = 0.0;
    for (const InterfaceColors& part : *m_colors) {
      sum += part.area * function(part);
      area += part.area;
    }
    return sum / area;
  }
  double computeScore(const ColorAdjustment& knobs) const {
    return mean([&](const InterfaceColors& part) {
      return contrastScore(measureAdjustedContrast(knobs, part, m_saturation, m_g));
    });
  }
  double worth() const { return std::min(m_score, sufficientScore) - change() / m_changeScale; }
  /// Difference of the colours from their own, both sides together.
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

/// Parts of the border with enough of it to matter.
std::vector<ComponentInterface> selectMajor(std::vector<ComponentInterface> interfaces) {
  constexpr double enough = 0.05;
  double area = 0.0;
  for (const ComponentInterface& part : interfaces)
    area += part.area;
  std::erase_if(interfaces, [&](const ComponentInterface& b) { return b.area < enough * area; });
  return interfaces;
}

} // namespace

Rgb adjustContext(const Rgb& seen, const ColorAdjustment& adjustment) {
  const Lab lab = toLab(seen);
  return reduceToGamut({lab.L + adjustment.contextLightness * (adjustment.contextGoal - lab.L),
                        adjustment.contextSaturation * lab.a,
                        adjustment.contextSaturation * lab.b});
}

Rgb adjustFocus(const Rgb& seen, const ColorAdjustment& adjustment) {
  const Lab lab = toLab(seen),
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
  constexpr double white = 100.0, bright = 72.0, dim = 40.0;
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
                      adjustable == Adjustable::both ? limits.saturation : graySaturation);
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
  const auto seen = [&](std::uint8_t component, double scalar) {
    return toReflectance(Rgb(albedoOf(tint.albedo[component], transfer)(scalar)), g);
  };
  const std::vector<ComponentInterface> parts = selectMajor(interfaces);
  std::vector<InterfaceColors> colors;
  for (const ComponentInterface& part : parts)
    colors.push_back(
        {seen(part.focus, part.focusScalar), seen(part.context, part.contextScalar), part.area});
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
  std::vector<std::string> parts = {"colour-blind " + toString(contrast.colorBlind(), 3)};
  const auto add = [&](const std::string& what, double ColorAdjustment::*member) {
    if (adjustment.*member != neutral.*member)
      parts.push_back(what + toString(adjustment.*member, 3));
  };
  add("surroundings' colour x ", &ColorAdjustment::contextSaturation);
  add("lightness evened by ", &ColorAdjustment::contextLightness);
  add("focus's lightness + ", &ColorAdjustment::focusLightness);
  add("colour x ", &ColorAdjustment::focusChroma);
  add(concat("toward ", accentColors[adjustment.accent].name, " by "),
      &ColorAdjustment::focusAccent);
  return concat(toString(contrast.deltaE[0], 3), " of ", sanitize(chosen.segment), " to ",
                sanitize(chosen.neighbor), " (", join(parts, ", "), ")");
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
