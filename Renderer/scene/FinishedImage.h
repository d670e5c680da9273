#pragma once
// What turns a rendered film into a finished image: denoising, and the header that reproduces it.

#include "denoise/filter/Filter.h"
#include "scene/PreparedScene.h"

#include <map>
#include <optional>
#include <string>

namespace fenestra::core {

/// Throws Error (output) if an image of the request's size does not fit into physical memory: Linux
/// grants more, and kills the process when it is used.
void checkMemory(const RenderRequest& scene);

/// Finished fraction of a render, 0 to 1, by the limit that it is nearest to. `seconds`: since its
/// start.
double estimateFraction(const RenderMonitor& monitor, const RenderSettings& settings, double pixels,
                        double seconds);

/// Denoiser of one render. The scene must outlive it.
class ImageDenoiser {
public:
  /// `stop`: once true, images are of no use, and the denoiser returns soon with any.
  explicit ImageDenoiser(const PreparedScene& scene, const StopFlag& stop = neverStopped)
      : m_scene(scene), m_stop(stop) {}

  /// Estimates PassEnd::displayNoise, the denoised noise, in monitor.onPassEnd. The callback stores
  /// its last result here.
  void attach(RenderMonitor& monitor);
  /// Denoised image; nullopt: the scene has no feature buffers.
  std::optional<FilteredImage> apply(const RenderResult& result) const;

private:
  const PreparedScene& m_scene;
  const StopFlag& m_stop;
  FilteredImage m_checked;            ///< by the last noise check
  std::uint64_t m_checkedSamples = 0; ///< samples per pixel of that check; 0: none yet
};

/// Estimated noise after denoising, on the scale of Film::noise(); nullopt: no estimate.
std::optional<double> denoisedNoise(const std::optional<FilteredImage>& filtered);

/// Image header: what reproduces the image, except version, camera and files.
std::map<std::string, std::string> makeImageHeader(const PreparedScene& scene,
                                                   const RenderSettings& settings,
                                                   const RenderResult& result);

/// Header text on how an image was denoised.
std::string describeDenoising(const std::optional<FilteredImage>& filtered);

} // namespace fenestra::core
