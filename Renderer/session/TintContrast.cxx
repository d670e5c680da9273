#include "session/TintContrast.h"

#include "base/Text.h"
#include "base/safe/ShownText.h"
#include "model/medium/ContextStyle.h"
#include "model/medium/Reflectance.h"

#include <algorithm>
#include <functional>

namespace fenestra {
namespace {

Rgb shownColor(const Lab& lab) {
  return linearOf(lab).max(0.0).min(whitest);
}

/// Colour, linear, as pictures show it on the whole: its part in shadow, and under what the wet
/// surface reflects. Chosen by eye for the means inside the edges of five foci (abdomen, knee)
/// under cinema, before the tone curve; single ones were checked, to 0.06. Outside the edges it
/// holds on the whole alone.
Rgb inScene(const Rgb& seen) {
  constexpr double lit = 0.4, reflected = 0.09;
  return lit * seen + reflected;
}

/// Albedo of a component over the scalar.
const ColorFunction& albedoOf(const std::optional<ColorFunction>& own,
                              const TransferFunction& transfer) {
  return own ? *own : transfer.albedo;
}

/// Turns knobs until a border has enough of what is wanted.
class Knobs {
public:
  Knobs(const std::vector<BorderColors>& colors, const ContrastKnobs& start, double saturation,
        double g)
      : m_colors(colors),
        m_saturation(saturation),
        m_g(g),
        m_knobs(start),
        m_share(shareOf(start)) {}

  const ContrastKnobs& knobs() const { return m_knobs; }

  /// Turns a knob from where it is, in steps, to at most `farthest`.
  void turn(double ContrastKnobs::*knob, double farthest) {
    constexpr int steps = 20;
    const double first = m_knobs.*knob;
    for (int i = 1; i <= steps && m_share < enoughShare; ++i) {
      ContrastKnobs turned = m_knobs;
      turned.*knob = first + (farthest - first) * i / steps;
      if (const double share = shareOf(turned); share > m_share) {
        m_share = share;
        m_knobs = turned;
      }
    }
  }

  /// -1 if the focus is darker than its neighbours, else 1.
  double awayFromContext() const {
    double difference = 0.0;
    for (const BorderColors& part : m_colors)
      difference += part.area * (labOf(changedFocus(part.focus, m_knobs)).L -
                                 labOf(changedContext(part.context, m_knobs)).L);
    return difference < 0.0 ? -1.0 : 1.0;
  }

private:
  /// Mean over the border.
  double shareOf(const ContrastKnobs& knobs) const {
    double sum = 0.0, area = 0.0;
    for (const BorderColors& part : m_colors) {
      sum += part.area * tintShare(contrastUnder(knobs, part, m_saturation, m_g));
      area += part.area;
    }
    return m_colors.empty() ? 1.0 : sum / area;
  }

  const std::vector<BorderColors>& m_colors;
  double m_saturation, m_g;
  ContrastKnobs m_knobs;
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
  const Lab lab = labOf(seen);
  return shownColor(
      {lab.L + knobs.focusLightness, knobs.focusChroma * lab.a, knobs.focusChroma * lab.b});
}

double tintShare(const Contrast& contrast) {
  constexpr double normal = 16.0, colorBlind = 13.0, lightness = 15.0;
  return 0.25 * (std::min(1.0, contrast.deltaE[0] / normal) +
                 std::min(1.0, contrast.deltaE[1] / colorBlind) +
                 std::min(1.0, contrast.deltaE[2] / colorBlind) +
                 std::min(1.0, contrast.deltaL / lightness));
}

Contrast contrastUnder(const ContrastKnobs& knobs, const BorderColors& colors, double saturation,
                       double g) {
  const ContextStyle style{.focus = nullptr, .saturation = saturation};
  const Rgb context = style.paled(albedoFor(changedContext(colors.context, knobs), g));
  return contrastBetween(inScene(changedFocus(colors.focus, knobs)),
                         inScene(reflectance(context, g)));
}

ContrastKnobs chosenKnobs(const std::vector<BorderColors>& colors, const ContextColors& context,
                          bool isAutomatic, double saturation, double g) {
  constexpr double leastSaturation = 0.5, mostLightness = 0.35, mostChroma = 1.4, mostShift = 12.0,
                   white = 100.0;
  ContrastKnobs start;
  start.contextSaturation = context.saturation.value_or(start.contextSaturation);
  if (context.lightness) {
    start.contextLightness = *context.lightness;
    start.contextGoal = white;
  }
  if (!isAutomatic)
    return start;
  Knobs knobs(colors, start, saturation, g);
  if (!context.saturation)
    knobs.turn(&ContrastKnobs::contextSaturation, leastSaturation);
  if (!context.lightness)
    knobs.turn(&ContrastKnobs::contextLightness, mostLightness);
  knobs.turn(&ContrastKnobs::focusChroma, mostChroma);
  knobs.turn(&ContrastKnobs::focusLightness, knobs.awayFromContext() * mostShift);
  return knobs.knobs();
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
  TintContrast result{.knobs =
                          chosenKnobs(colors, table.context, table.hasContrast, saturation, g)};
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
  const auto tell = [&](const char* what, double ContrastKnobs::*knob) {
    if (knobs.*knob != none.*knob)
      turned.push_back(what + numberText(knobs.*knob, 3));
  };
  tell("surroundings' colour x ", &ContrastKnobs::contextSaturation);
  tell("lightness evened by ", &ContrastKnobs::contextLightness);
  tell("focus's colour x ", &ContrastKnobs::focusChroma);
  tell("lightness + ", &ContrastKnobs::focusLightness);
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
