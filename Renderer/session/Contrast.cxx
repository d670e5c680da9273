#include "session/Contrast.h"

#include "base/Color.h"
#include "base/Text.h"
#include "files/pictures/DisplayTransform.h"
#include "model/medium/ContextStyle.h"
#include "model/medium/Reflectance.h"

#include <algorithm>

namespace fenestra {
namespace {

/// Mean over scalars of the colour that an eye sees of matter with `albedoOf` their albedo.
template <typename AlbedoOf>
Rgb meanColor(const std::vector<double>& scalars, double g, const AlbedoOf& albedoOf) {
  Rgb sum = Rgb::Zero();
  for (const double scalar : scalars)
    sum += toReflectance(Rgb(albedoOf(scalar)), g);
  return sum / static_cast<double>(scalars.size());
}

/// Display light, linear, of matter of that colour.
Rgb displayed(const Rgb& seen) {
  constexpr double light = 1.1;
  std::vector<float> pixel(4, 1.0F);
  for (int c = 0; c < 3; ++c)
    pixel[static_cast<std::size_t>(c)] = static_cast<float>(light * seen[c]);
  pixel = toDisplay(pixel, {DisplayView::film});
  return decodeSrgb(Rgb(double{pixel[0]}, double{pixel[1]}, double{pixel[2]}));
}

} // namespace

double Contrast::share() const {
  constexpr double normal = 20.0, colorBlind = 12.0;
  return std::min({deltaE[0] / normal, deltaE[1] / colorBlind, deltaE[2] / colorBlind});
}

Contrast shownContrast(const Rgb& focus, const Rgb& context,
                       double (*difference)(const Lab&, const Lab&)) {
  Contrast contrast = {};
  for (const ColorVision sight : colorVisions)
    contrast.deltaE[static_cast<std::size_t>(sight)] =
        difference(toLab(simulateVision(sight, focus)), toLab(simulateVision(sight, context)));
  contrast.deltaL = std::abs(toLab(focus).L - toLab(context).L);
  return contrast;
}

Contrast contrastBetween(const Rgb& focus, const Rgb& context) {
  return shownContrast(displayed(focus), displayed(context), deltaE2000);
}

Contrast contrastAt(const BorderScalars& border, const TransferFunction& transfer,
                    double saturation) {
  const ContextStyle style{.focus = nullptr, .saturation = saturation};
  return contrastBetween(meanColor(border.focus, transfer.g, transfer.albedo),
                         meanColor(border.context, transfer.g, [&](double scalar) {
                           return style.desaturate(transfer.albedo(scalar));
                         }));
}

FocusContrast chosenContrast(const std::optional<double>& asked, const Mask& focus,
                             const Volume& volume, const TransferFunction& transfer) {
  const BorderScalars border = borderScalars(focus, volume, transfer);
  if (border.focus.empty() || border.context.empty())
    return {asked.value_or(1.0)};
  const auto at = [&](double saturation) {
    return FocusContrast{saturation, contrastAt(border, transfer, saturation)};
  };
  FocusContrast best = at(asked.value_or(1.0));
  if (asked)
    return best;
  for (const double saturation : {pale, grey}) {
    if (best.contrast->share() > 1.0)
      break;
    const FocusContrast paler = at(saturation);
    if (paler.contrast->share() > best.contrast->share())
      best = paler;
  }
  return best;
}

std::string told(const FocusContrast& chosen) {
  if (!chosen.contrast)
    return "";
  const std::string desaturated =
      chosen.saturation < 1.0 ? "; surroundings paled to " + toString(chosen.saturation, 3) : "";
  return concat(toString(chosen.contrast->deltaE[0], 3), " (colour-blind ",
                toString(chosen.contrast->colorBlind(), 3), desaturated, ")");
}

} // namespace fenestra
