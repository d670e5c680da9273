#include "scene/Contrast.h"

#include "base/Color.h"
#include "base/Text.h"
#include "files/images/DisplayTransform.h"
#include "model/medium/ContextStyle.h"
#include "model/medium/Reflectance.h"

#include <algorithm>

namespace fenestra::core {
namespace {

/// Mean reflected color of thick media with the albedo `albedoOf` of the scalars.
template <typename AlbedoOf>
Rgb meanReflectance(const std::vector<double>& scalars, double g, const AlbedoOf& albedoOf) {
  Rgb sum = Rgb::Zero();
  for (const double scalar : scalars)
    sum += toReflectance(Rgb(albedoOf(scalar)), g);
  return sum / static_cast<double>(scalars.size());
}

/// Linear display color of a medium with this reflectance.
Rgb toDisplayLight(const Rgb& reflectance) {
  constexpr double light = 1.1;
  std::vector<float> pixel(4, 1.0F);
  for (int c = 0; c < 3; ++c)
    pixel[static_cast<std::size_t>(c)] = static_cast<float>(light * reflectance[c]);
  pixel = toDisplay(pixel, {DisplayView::film});
  return decodeSrgb(Rgb(double{pixel[0]}, double{pixel[1]}, double{pixel[2]}));
}

} // namespace

Contrast measureContrast(const Rgb& focus, const Rgb& context,
                         double (*difference)(const Lab&, const Lab&)) {
  Contrast contrast = {};
  for (const ColorVision vision : colorVisions)
    contrast.deltaE[static_cast<std::size_t>(vision)] =
        difference(toLab(simulateVision(vision, focus)), toLab(simulateVision(vision, context)));
  contrast.deltaL = std::abs(toLab(focus).L - toLab(context).L);
  return contrast;
}

Contrast measureReflectedContrast(const Rgb& focus, const Rgb& context) {
  return measureContrast(toDisplayLight(focus), toDisplayLight(context), deltaE2000);
}

Contrast measureInterfaceContrast(const InterfaceScalars& interface,
                                  const TransferFunction& transfer, double saturation) {
  const ContextStyle style{.focus = nullptr, .saturation = saturation};
  return measureReflectedContrast(
      meanReflectance(interface.focus, transfer.g, transfer.albedo),
      meanReflectance(interface.context, transfer.g,
                      [&](double scalar) { return style.desaturate(transfer.albedo(scalar)); }));
}

FocusContrast measureFocusContrast(double saturation, const Mask& focus, const Volume& volume,
                                   const TransferFunction& transfer) {
  const InterfaceScalars interface = sampleInterface(focus, volume, transfer);
  if (interface.focus.empty() || interface.context.empty())
    return {saturation};
  return {saturation, measureInterfaceContrast(interface, transfer, saturation)};
}

std::string summary(const FocusContrast& contrast) {
  if (!contrast.contrast)
    return "";
  const std::string desaturated = contrast.saturation < 1.0 ? "; surroundings desaturated to " +
                                                                  toString(contrast.saturation, 3)
                                                            : "";
  return concat("contrast of the focus: dE ", toString(contrast.contrast->deltaE[0], 3),
                " (color-blind ", toString(contrast.contrast->colorBlind(), 3), ")", desaturated);
}

} // namespace fenestra::core
