#pragma once
// Steps shared by render, serve, turntable and merge. Files are checked before the long render, and
// written after it.

#include "program/MergedOptions.h"
#include "scene/FinishedImage.h"

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

/// Warning of a render whose GPU failed, `reason` being its RenderResult::gpuFailure.
std::string describeGpuFailure(const std::string& reason);

/// Writes all of options.outputs; the caller commits them. Headers store what reproduces the image,
/// including the command `fenestra arguments…`, and how it was denoised. Throws Error (output).
void writeImages(const RenderOptions& options, const PreparedScene& scene,
                 const RenderResult& result, const std::optional<FilteredImage>& filtered,
                 const std::vector<std::string>& arguments, Outputs& outputs);

} // namespace fenestra::core
