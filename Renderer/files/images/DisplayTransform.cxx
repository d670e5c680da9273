#include "files/images/DisplayTransform.h"

#include "base/TextStream.h"
#include "io/EmbeddedResources.h"

#include <OpenColorIO/OpenColorIO.h>

#include <algorithm>
#include <cmath>

namespace fenestra::core {

namespace ocio = OCIO_NAMESPACE;

namespace {

/// Upper limit of radiance, far above white in every view. OpenColorIO overflows near the largest
/// floats.
constexpr float maxRadiance = 65504.0f;

ocio::ConstConfigRcPtr loadConfig() {
  ocio::SetLoggingFunction([](const char*) {}); // failures are thrown; keep stderr clean
  TextReader text{std::string(findResource("color/fenestra.ocio"))};
  return ocio::Config::CreateFromStream(text);
}

/// Name of the view in the OpenColorIO configuration.
const char* ocioViewName(DisplayView view) {
  switch (view) {
  case DisplayView::film:
    return "Film";
  case DisplayView::photographic:
    return "Photographic";
  case DisplayView::standard:
    break;
  }
  return "Standard";
}

ocio::ConstCPUProcessorRcPtr makeProcessor(DisplayView view) {
  static const ocio::ConstConfigRcPtr config = loadConfig();
  const auto transform = ocio::DisplayViewTransform::Create();
  transform->setSrc(ocio::ROLE_SCENE_LINEAR);
  transform->setDisplay("sRGB");
  transform->setView(ocioViewName(view));
  // The default optimization approximates log and exp. That shifts black and varies between CPUs.
  return config->getProcessor(transform)->getOptimizedCPUProcessor(ocio::OPTIMIZATION_LOSSLESS);
}

/// Clamps to [0, maxValue]; NaN becomes 0.
float clampOrZero(float value, float maxValue) {
  return value > 0.0f ? std::min(value, maxValue) : 0.0f;
}

} // namespace

std::string_view toString(DisplayView view) {
  switch (view) {
  case DisplayView::film:
    return "film";
  case DisplayView::photographic:
    return "photographic";
  case DisplayView::standard:
    break;
  }
  return "standard";
}

std::vector<float> toDisplay(std::vector<float> rgba, const Display& display) {
  if (rgba.empty())
    return rgba; // OpenColorIO rejects empty images
  const bool isExposed = display.view != DisplayView::standard;
  const auto gain = static_cast<float>(isExposed ? std::exp2(display.exposure) : 1.0);
  for (std::size_t i = 0; i < rgba.size(); i += 4) {
    const float alpha = rgba[i + 3] = clampOrZero(rgba[i + 3], 1.0f);
    for (std::size_t c = i; c < i + 3; ++c)
      rgba[c] = alpha > 0.0f ? clampOrZero(rgba[c] / alpha * gain, maxRadiance) : 0.0f;
  }
  constexpr std::ptrdiff_t pixel = 4 * sizeof(float); // the stride skips alpha
  ocio::PackedImageDesc colors(rgba.data(), static_cast<long>(rgba.size() / 4), 1, 3,
                               ocio::BIT_DEPTH_F32, sizeof(float), pixel, ocio::AutoStride);
  makeProcessor(display.view)->apply(colors);
  // Rounding can exceed 1.
  std::ranges::transform(rgba, rgba.begin(), [](float x) { return std::clamp(x, 0.0f, 1.0f); });
  return rgba;
}

} // namespace fenestra::core
