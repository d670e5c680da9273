#include "files/pictures/DisplayTransform.h"

#include "base/Error.h"
#include "base/TextStream.h"
#include "base/safe/EmbeddedResources.h"

#include <OpenColorIO/OpenColorIO.h>

namespace fenestra {

namespace ocio = OCIO_NAMESPACE;

namespace {

const char* const display = "sRGB";

/// Upper limit of radiance, far above white in any view: OpenColorIO overflows near the largest
/// floats.
constexpr float brightest = 65504.0f;

ocio::ConstConfigRcPtr loadConfig() {
  ocio::SetLoggingFunction([](const char*) {}); // silent on standard error: failures are thrown
  TextReader text{std::string(embeddedResource("color/fenestra.ocio"))};
  return ocio::Config::CreateFromStream(text);
}

const ocio::ConstConfigRcPtr& config() {
  static const ocio::ConstConfigRcPtr loaded = loadConfig();
  return loaded;
}

/// Views of the display: the full list, which environment variables cannot shorten.
std::vector<std::string> viewNames() {
  std::vector<std::string> names;
  for (int i = 0; i < config()->getNumViews(ocio::VIEW_DISPLAY_DEFINED, display); ++i)
    names.emplace_back(config()->getView(ocio::VIEW_DISPLAY_DEFINED, display, i));
  return names;
}

std::string checkedView(const std::string& view) {
  const std::vector<std::string> names = viewNames();
  if (view.empty())
    return names.front();
  if (std::find(names.begin(), names.end(), view) != names.end())
    return view;
  throw usageError("display view ", view, ": is unknown; choose one of ", joined(names, ", "));
}

/// Clamps to [0, brightest]; NaN becomes 0.
float sanitized(float value) {
  return value > 0.0f ? std::min(value, brightest) : 0.0f;
}

} // namespace

struct DisplayTransform::Processor {
  ocio::ConstCPUProcessorRcPtr cpu;
};

DisplayTransform::DisplayTransform(const std::string& view) {
  const auto transform = ocio::DisplayViewTransform::Create();
  transform->setSrc(ocio::ROLE_SCENE_LINEAR);
  transform->setDisplay(display);
  transform->setView(checkedView(view).c_str());
  // Lossless, since the default's fast approximations of log and exp move black and differ by
  // machine.
  m_processor = std::make_unique<Processor>(Processor{
      config()->getProcessor(transform)->getOptimizedCPUProcessor(ocio::OPTIMIZATION_LOSSLESS)});
}

DisplayTransform::~DisplayTransform() = default;

void DisplayTransform::apply(float* rgb, std::size_t count) const {
  if (count == 0)
    return; // OpenColorIO refuses empty pictures
  float* const end = rgb + 3 * count;
  std::transform(rgb, end, rgb, sanitized);
  ocio::PackedImageDesc pixels(rgb, static_cast<long>(count), 1, ocio::CHANNEL_ORDERING_RGB);
  m_processor->cpu->apply(pixels);
  // Rounding takes white past 1.
  std::transform(rgb, end, rgb, [](float value) { return std::clamp(value, 0.0f, 1.0f); });
}

std::vector<float> toDisplay(const Image& image, const DisplayTransform& transform) {
  const std::vector<float>* const planes[3] = {&image.channels.at("R"), &image.channels.at("G"),
                                               &image.channels.at("B")};
  const std::vector<float>* const alphas = image.find("A");
  const std::size_t count = planes[0]->size();
  const auto alphaOf = [&](std::size_t i) {
    return alphas ? std::min(sanitized((*alphas)[i]), 1.0f) : 1.0f;
  };
  std::vector<float> rgb(3 * count);
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t c = 0; c < 3; ++c)
      rgb[3 * i + c] = alphaOf(i) > 0.0f ? (*planes[c])[i] / alphaOf(i) : 0.0f;
  transform.apply(rgb.data(), count);
  std::vector<float> rgba(4 * count);
  for (std::size_t i = 0; i < count; ++i) {
    std::copy_n(rgb.begin() + static_cast<std::ptrdiff_t>(3 * i), 3,
                rgba.begin() + static_cast<std::ptrdiff_t>(4 * i));
    rgba[4 * i + 3] = alphaOf(i);
  }
  return rgba;
}

} // namespace fenestra
