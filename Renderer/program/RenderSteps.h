#pragma once
// Steps of render, serve and turntable. Files are checked before the long work, and written after
// it.

#include "program/MergedOptions.h"
#include "scene/Denoising.h"
#include "scene/PreparedScene.h"

namespace fenestra {

struct RenderJob {
  OptionValues stored; ///< given, and stored in the scene
  OptionValues values; ///< those, and the preset's
  RenderOptions options;
  Input input; ///< of options.scene, opened
};
/// Throws Error: usage; input for a damaged scene or preset.
RenderJob makeRenderJob(const OptionValues& given);

/// Declares all results that `options` name, and enters all their inputs into the ledger. Throws
/// Error: usage or output.
void declareOutputs(const RenderOptions& options, Outputs& outputs);

/// Throws Error (output) if memory cannot hold the picture.
void checkMemory(const RenderRequest& scene);

/// Filter of one render, as the options ask for it. Both must outlive it.
class ImageDenoiser {
public:
  ImageDenoiser(const RenderOptions& options, const PreparedScene& scene)
      : m_options(options), m_scene(scene) {}

  /// Settings of the render; looks at the noise of filtered pictures are kept here.
  RenderSettings settings();
  /// The film filtered, if the scene has features; else nothing.
  std::optional<FilteredImage> apply(const RenderResult& result) const;

private:
  const RenderOptions& m_options;
  const PreparedScene& m_scene;
  FilteredImage m_checked;            ///< at the last look
  std::uint64_t m_checkedSamples = 0; ///< samples a pixel then; 0: no look yet
};

/// Error that the filter tells of itself, as Film::noise(); nothing if it tells none.
std::optional<double> denoisedNoise(const std::optional<FilteredImage>& filtered);

/// Writes all of options.outputs; the caller commits them. Each header has the data that reproduce
/// the picture, `fenestra words…` among them; a picture that is `filtered` says so. Throws Error
/// (output).
void writeImages(const RenderOptions& options, const PreparedScene& scene,
                 const RenderResult& result, const std::optional<FilteredImage>& filtered,
                 const std::vector<std::string>& arguments, Outputs& outputs);

} // namespace fenestra
