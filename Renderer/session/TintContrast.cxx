#include "session/TintContrast.h"

#include "base/Color.h"
#include "base/Text.h"
#include "base/safe/ShownText.h"
#include "model/medium/ContextStyle.h"
#include "model/medium/Reflectance.h"

#include <algorithm>
#include <functional>

namespace fenestra {
namespace {

bool isShown(const Rgb& color) {
  return color.minCoeff() >= 0.0 && color.maxCoeff() <= whitest;
}

/// Colour, linear, with as much of its chroma as the display has.
Rgb shownColor(const Lab& lab) {
  constexpr int halvings = 20;
  const auto withChroma = [&](double fraction) {
    return linearOf({lab.L, fraction * lab.a, fraction * lab.b});
  };
  double least = 0.0, most = 1.0;
  if (isShown(withChroma(most)))
    return withChroma(most);
  for (int i = 0; i < halvings; ++i) {
    const double middle = 0.5 * (least + most);
    (isShown(withChroma(middle)) ? least : most) = middle;
  }
  return withChroma(least).max(0.0).min(whitest);
}

/// Loss of L* of a context at the edge: where it faces the light, and in a groove
/// that the focus shades. With what pictured() says, chosen by eye for means from 3 to 8 pixels to
/// both sides of the edges of seven foci (abdomen, knee, torso; LookBenchmark) under cinema and the
/// film curve.
constexpr std::array contextShades = {-3.0, 4.0};

/// Colour, linear, that pictures show of matter at the edge: shadow and what wet surfaces reflect
/// leave less than half of the differences in lightness.
Rgb pictured(const Rgb& seen, double shade) {
  constexpr double darkest = 29.0, lightness = 0.43, saturation = 0.62;
  const Lab lab = labOf(seen);
  const double L = darkest + lightness * lab.L, chroma = saturation * L / std::max(lab.L, 1.0);
  return linearOf({L - shade, chroma * lab.a, chroma * lab.b}).max(0.0).min(1.0);
}

/// Albedo of a component over the scalar.
const ColorFunction& albedoOf(const std::optional<ColorFunction>& own,
                              const TransferFunction& transfer) {
  return own ? *own : transfer.albedo;
}

/// Context's saturation before any knob is turned, how far knobs may be turned, and the difference
/// of colours from their own that all of what is wanted would be worth.
struct Limits {
  double muted;
  double saturation, lightness, shift, chroma, accent;
  double worth;
};
/// Tissue stays tissue; and, of a focus that would not be told from its like (bowel in bowel, a
/// vertebra on another), paint.
constexpr Limits gentle{0.6, 0.5, 0.35, 12.0, 1.4, 0.35, 300.0},
    strong{1.0, 0.3, 0.5, 18.0, 1.7, 0.6, 600.0};

/// Turns knobs until a border has enough of what is wanted.
class Knobs {
public:
  Knobs(const std::vector<BorderColors>& colors, const ContrastKnobs& start, double worth,
        double saturation, double g)
      : m_colors(&colors),
        m_worth(worth),
        m_saturation(saturation),
        m_g(g),
        m_start(start),
        m_knobs(start),
        m_share(shareOf(start)) {}

  const ContrastKnobs& knobs() const { return m_knobs; }
  double share() const { return m_share; }

  /// Turns a knob from where it is, in steps, to at most `farthest`.
  void turn(double ContrastKnobs::*knob, double farthest) {
    const double first = m_knobs.*knob;
    for (int i = 1; i <= steps && m_share < enoughShare; ++i)
      take(knob, first + (farthest - first) * i / steps,
           [this](double fraction) { return fraction > m_share; });
  }

  /// Turns all knobs back toward the start, from the last to the first, as far as that costs
  /// nothing that is wanted: again as long as one that is back lets another follow.
  void turnBack() {
    ContrastKnobs before;
    do {
      before = m_knobs;
      for (const auto knob : {&ContrastKnobs::focusAccent, &ContrastKnobs::focusChroma,
                              &ContrastKnobs::focusLightness, &ContrastKnobs::contextLightness,
                              &ContrastKnobs::contextSaturation})
        turnBack(knob);
    } while (!(m_knobs == before));
  }

  /// Turns the focus toward the accent that is worth most, if one is worth the change, of those
  /// about as light as itself: a pale organ in dark red would be taken for muscle.
  void turnToAccent(double farthest) {
    constexpr double mostApart = 40.0;
    const double own = meanOf([](const BorderColors& part) { return labOf(part.focus).L; });
    Knobs best = *this;
    for (std::size_t i = 0; i < accents.size() && m_share < enoughShare; ++i) {
      if (std::abs(labOf(decodeSrgb(colorOf(accents[i].color))).L - own) > mostApart)
        continue;
      Knobs turned = *this;
      turned.m_knobs.accent = i;
      turned.turn(&ContrastKnobs::focusAccent, farthest);
      if (turned.isBetterThan(best))
        best = turned;
    }
    m_knobs = best.m_knobs;
    m_share = best.m_share;
  }

  /// True if its share is worth its change.
  bool isBetterThan(const Knobs& other) const { return worth() > other.worth(); }

private:
  static constexpr int steps = 20;

  void turnBack(double ContrastKnobs::*knob) {
    const double last = m_knobs.*knob, needed = std::min(m_share, enoughShare);
    for (int i = 1; i <= steps; ++i)
      if (!take(knob, last + (m_start.*knob - last) * i / steps,
                [needed](double fraction) { return fraction >= needed; }))
        return;
  }

  bool take(double ContrastKnobs::*knob, double value, const auto& isWanted) {
    ContrastKnobs turned = m_knobs;
    turned.*knob = value;
    const double share = shareOf(turned);
    if (!isWanted(share))
      return false;
    m_knobs = turned;
    m_share = share;
    return true;
  }

  /// Mean over the border of a function of its parts.
  double meanOf(const auto& function) const {
    double sum = 0.0, area = 0.0;
    for (const BorderColors& part : *m_colors) {
      sum += part.area * function(part);
      area += part.area;
    }
    return sum / area;
  }
  double shareOf(const ContrastKnobs& knobs) const {
    return meanOf([&](const BorderColors& part) {
      return tintShare(contrastUnder(knobs, part, m_saturation, m_g));
    });
  }
  double worth() const { return std::min(m_share, enoughShare) - change() / m_worth; }
  /// Difference of the colours from their own, both sides together.
  double change() const {
    return meanOf([&](const BorderColors& part) {
      return deltaE76(labOf(part.focus), labOf(changedFocus(part.focus, m_knobs))) +
             deltaE76(labOf(part.context), labOf(changedContext(part.context, m_knobs)));
    });
  }

  const std::vector<BorderColors>* m_colors;
  double m_worth, m_saturation, m_g;
  ContrastKnobs m_start, m_knobs;
  double m_share;
};

/// Parts of the border with enough of it to matter.
std::vector<ComponentBorder> notable(std::vector<ComponentBorder> borders) {
  constexpr double enough = 0.05;
  double area = 0.0;
  for (const ComponentBorder& border : borders)
    area += border.area;
  std::erase_if(borders, [&](const ComponentBorder& b) { return b.area < enough * area; });
  return borders;
}

} // namespace

Rgb changedContext(const Rgb& seen, const ContrastKnobs& knobs) {
  const Lab lab = labOf(seen);
  return shownColor({lab.L + knobs.contextLightness * (knobs.contextGoal - lab.L),
                     knobs.contextSaturation * lab.a, knobs.contextSaturation * lab.b});
}

Rgb changedFocus(const Rgb& seen, const ContrastKnobs& knobs) {
  const Lab lab = labOf(seen), accent = labOf(decodeSrgb(colorOf(accents[knobs.accent].color)));
  const auto mixed = [&](double own, double other) {
    return own + knobs.focusAccent * (other - own);
  };
  return shownColor({mixed(lab.L + knobs.focusLightness, accent.L),
                     mixed(knobs.focusChroma * lab.a, accent.a),
                     mixed(knobs.focusChroma * lab.b, accent.b)});
}

double tintShare(const Contrast& contrast) {
  constexpr double normal = 22.0, colorBlind = 13.2, lightness = 8.8;
  return 0.25 * (std::min(1.0, contrast.deltaE[0] / normal) +
                 std::min(1.0, contrast.deltaE[1] / colorBlind) +
                 std::min(1.0, contrast.deltaE[2] / colorBlind) +
                 std::min(1.0, contrast.deltaL / lightness));
}

Contrast contrastUnder(const ContrastKnobs& knobs, const BorderColors& colors, double saturation,
                       double g) {
  const ContextStyle style{.focus = nullptr, .saturation = saturation};
  const Rgb focus = changedFocus(colors.focus, knobs),
            context = reflectance(
                Rgb(style.paled(albedoFor(changedContext(colors.context, knobs), g))), g);
  const auto in = [&](double shade) {
    return shownContrast(pictured(focus, 0.0), pictured(context, shade), deltaE76);
  };
  return std::min(in(contextShades[0]), in(contextShades[1]),
                  [](const Contrast& x, const Contrast& y) { return tintShare(x) < tintShare(y); });
}

ContrastKnobs chosenKnobs(const std::vector<BorderColors>& colors, const ContextColors& context,
                          Turned what, double saturation, double g) {
  constexpr double white = 100.0, bright = 72.0, dim = 40.0;
  ContrastKnobs start;
  start.contextSaturation = context.saturation.value_or(start.contextSaturation);
  if (context.lightness) {
    start.contextLightness = *context.lightness;
    start.contextGoal = white;
  }
  if (what == Turned::nothing || colors.empty())
    return start;
  const auto turned = [&](const Limits& limits, double shift, double goal) {
    if (!context.lightness)
      start.contextGoal = goal;
    if (!context.saturation && what == Turned::both)
      start.contextSaturation = limits.muted;
    Knobs knobs(colors, start, limits.worth, saturation, g);
    if (!context.saturation)
      knobs.turn(&ContrastKnobs::contextSaturation,
                 what == Turned::both ? limits.saturation : grey);
    if (!context.lightness)
      knobs.turn(&ContrastKnobs::contextLightness, limits.lightness);
    if (what == Turned::both) {
      knobs.turn(&ContrastKnobs::focusLightness, shift);
      knobs.turn(&ContrastKnobs::focusChroma, limits.chroma);
      knobs.turnToAccent(limits.accent);
    }
    knobs.turnBack();
    return knobs;
  };
  const auto darker = [&](const Limits& limits) { return turned(limits, -limits.shift, bright); };
  const auto lighter = [&](const Limits& limits) { return turned(limits, limits.shift, dim); };
  const Knobs dark = darker(gentle), light = lighter(gentle);
  const bool isLight = light.isBetterThan(dark);
  const Knobs& tissue = isLight ? light : dark;
  if (tissue.share() >= almostEnough)
    return tissue.knobs();
  return (isLight ? lighter(strong) : darker(strong)).knobs();
}

TintContrast tintContrast(const std::vector<ComponentBorder>& borders, const TintPlan& plan,
                          const Tint& tint, const MaterialTable& table,
                          const TransferFunction& transfer, double saturation) {
  const double g = transfer.g;
  const auto seen = [&](std::uint8_t component, double scalar) {
    return reflectance(Rgb(albedoOf(tint.albedo[component], transfer)(scalar)), g);
  };
  const std::vector<ComponentBorder> parts = notable(borders);
  std::vector<BorderColors> colors;
  for (const ComponentBorder& part : parts)
    colors.push_back(
        {seen(part.focus, part.focusScalar), seen(part.context, part.contextScalar), part.area});
  const bool isKnown = std::ranges::any_of(
      parts, [&](const ComponentBorder& part) { return tint.albedo[part.focus].has_value(); });
  const Turned what = !table.hasContrast ? Turned::nothing
                      : isKnown          ? Turned::both
                                         : Turned::context;
  TintContrast result{.knobs = chosenKnobs(colors, table.context, what, saturation, g)};
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const Contrast contrast = contrastUnder(result.knobs, colors[i], saturation, g);
    if (result.contrast && tintShare(contrast) >= tintShare(*result.contrast))
      continue;
    result.contrast = contrast;
    result.segment = plan.names[parts[i].focus];
    result.neighbour = plan.names[parts[i].context];
  }
  return result;
}

std::string told(const TintContrast& chosen) {
  if (!chosen.contrast)
    return "";
  const Contrast& contrast = *chosen.contrast;
  const ContrastKnobs &knobs = chosen.knobs, none;
  std::vector<std::string> turned = {"colour-blind " + numberText(contrast.colorBlind(), 3)};
  const auto tell = [&](const std::string& what, double ContrastKnobs::*knob) {
    if (knobs.*knob != none.*knob)
      turned.push_back(what + numberText(knobs.*knob, 3));
  };
  tell("surroundings' colour x ", &ContrastKnobs::contextSaturation);
  tell("lightness evened by ", &ContrastKnobs::contextLightness);
  tell("focus's lightness + ", &ContrastKnobs::focusLightness);
  tell("colour x ", &ContrastKnobs::focusChroma);
  tell(textOf("toward ", accents[knobs.accent].name, " by "), &ContrastKnobs::focusAccent);
  return textOf(numberText(contrast.deltaE[0], 3), " of ", shown(chosen.segment), " to ",
                shown(chosen.neighbour), " (", joined(turned, ", "), ")");
}

Tint contrastedTint(const Tint& tint, const TintPlan& plan, const ContrastKnobs& knobs,
                    const TransferFunction& transfer) {
  Tint result = tint;
  if (knobs == ContrastKnobs())
    return result;
  for (std::size_t i = 0; i < result.albedo.size(); ++i) {
    const auto change = plan.isFocus[i] ? changedFocus : changedContext;
    result.albedo[i] = albedoOf(tint.albedo[i], transfer).withKnots([&](ColorFunction::Knot& knot) {
      knot.value = albedoFor(change(reflectance(Rgb(knot.value), transfer.g), knobs), transfer.g);
    });
  }
  return result;
}

} // namespace fenestra
