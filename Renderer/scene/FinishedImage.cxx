#include "scene/FinishedImage.h"

#include "base/Error.h"
#include "base/PhysicalMemory.h"
#include "denoise/features/Denoising.h"

#include <algorithm>

namespace fenestra::core {

void checkMemory(const RenderRequest& scene) {
  constexpr double filter = 400.0; // buffers of the denoiser
  const double bytesPerPixel =     // film, and its channels as written
      2.0 * sizeof(PixelSums) + (scene.features ? filter : 0.0);
  constexpr double gigabyte = 1e9;
  const double needed = bytesPerPixel * scene.width * scene.height;
  const double available = physicalMemory();
  if (needed <= available)
    return;
  throw outputError(ErrorCode::outOfMemory, "size", "an image of ", scene.width, "x", scene.height,
                    " pixels needs ", toString(needed / gigabyte, 3),
                    " GB of memory, but this machine has ", toString(available / gigabyte, 3),
                    "; use a smaller size");
}

double estimateFraction(const RenderMonitor& monitor, const RenderSettings& settings, double pixels,
                        double seconds) {
  const double paths = static_cast<double>(monitor.paths);
  double most = std::max(paths / (static_cast<double>(settings.samples) * pixels),
                         seconds / settings.seconds);
  const double noise = monitor.noise;
  if (settings.noise > 0.0 && noise > 0.0) // variance is proportional to 1 / samples
    most = std::max(most, std::pow(settings.noise / noise, 2.0));
  return std::clamp(most, 0.0, 1.0);
}

void ImageDenoiser::attach(RenderMonitor& monitor) {
  monitor.onPassEnd = [this](const RenderResult& result, PassEnd& end) {
    if (!end.isNoiseDue)
      return;
    m_checked = denoise(result.film, m_scene.view(), *m_scene.features(), m_stop);
    m_checkedSamples = result.film.sampleCounts().max;
    // Two standard errors more, so that the render does not stop by chance.
    end.displayNoise = std::sqrt(m_checked.estimatedError + 2.0 * m_checked.errorUncertainty);
  };
}

std::optional<FilteredImage> ImageDenoiser::apply(const RenderResult& result) const {
  if (!m_scene.features())
    return std::nullopt;
  if (result.reason == StopReason::noise && m_checkedSamples == result.finishedSamples)
    return m_checked;
  return denoise(result.film, m_scene.view(), *m_scene.features(), m_stop);
}

std::optional<double> denoisedNoise(const std::optional<FilteredImage>& filtered) {
  if (!filtered || filtered->error[0].empty())
    return std::nullopt;
  return std::sqrt(filtered->estimatedError);
}

std::map<std::string, std::string> makeImageHeader(const PreparedScene& scene,
                                                   const RenderSettings& settings,
                                                   const RenderResult& result) {
  std::map<std::string, std::string> entries = {{"seed", concat(settings.seed)},
                                                {"sampling", toString(settings.sampling)},
                                                {"samples", concat(result.finishedSamples)}};
  if (const auto smoothing = scene.smoothing(); smoothing && smoothing->isApplied())
    entries["volume"] = describe(*smoothing);
  return entries;
}

/// Header text on how an image was denoised.
std::string describeDenoising(const std::optional<FilteredImage>& filtered) {
  const std::optional<double> noise = denoisedNoise(filtered);
  return concat("denoised by local linear regression, version ", filterVersion,
                ", on expected albedo, normal, depth and light; estimated error ",
                noise ? toString(*noise, 3) : "unknown");
}

} // namespace fenestra::core
