#pragma once
// Steps shared by render, serve, turntable and merge. Files are checked before the long render, and
// written after it.

#include "denoise/features/Denoising.h"
#include "program/MergedOptions.h"
#include "scene/PreparedScene.h"

namespace fenestra::core {

struct RenderJob {
  OptionValues stored; ///< given on the command line or stored in the scene
  OptionValues values; ///< the same, merged with the preset's
  RenderOptions options;
  Input input; ///< options.scene's, opened
};
/// Throws Error: usage; input for a damaged scene or preset.
RenderJob makeRenderJob(const OptionValues& given);

/// Declares all results named by `options`, and registers all their inputs. Throws Error: usage or
/// output.
void declareOutputs(const RenderOptions& options, Outputs& outputs);

/// Prints what was chosen for the scene (PreparedScene::choices), one fact per line.
void printFacts(const PreparedScene& scene);

/// Throws Error (output) if the image does not fit into memory.
void checkMemory(const RenderRequest& scene);

/// Denoiser of one render. Both arguments must outlive it.
class ImageDenoiser {
public:
  ImageDenoiser(const RenderOptions& options, const PreparedScene& scene)
      : m_options(options), m_scene(scene) {}

  /// Render settings. With a target for denoised noise, their callback stores its last result here.
  RenderSettings settings();
  /// Denoised image; nullopt: the scene has no feature buffers.
  std::optional<FilteredImage> apply(const RenderResult& result) const;

private:
  const RenderOptions& m_options;
  const PreparedScene& m_scene;
  FilteredImage m_checked;            ///< by the last noise check
  std::uint64_t m_checkedSamples = 0; ///< samples per pixel of that check; 0: none yet
};

/// Estimated noise after denoising, on the scale of Film::noise(); nullopt: no estimate.
std::optional<double> denoisedNoise(const std::optional<FilteredImage>& filtered);

/// Writes all of options.outputs; the caller commits them. Headers store what reproduces the image,
/// including the command `fenestra arguments…`, and how it was denoised. Throws Error (output).
void writeImages(const RenderOptions& options, const PreparedScene& scene,
                 const RenderResult& result, const std::optional<FilteredImage>& filtered,
                 const std::vector<std::string>& arguments, Outputs& outputs);

} // namespace fenestra::core
