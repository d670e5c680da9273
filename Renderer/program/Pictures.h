#pragma once
// Steps of render, serve and turntable. Files are checked before the long work, and written after
// it.

#include "program/MergedFlags.h"
#include "session/Scene.h"

namespace fenestra {

struct PictureRequest {
  FlagValues stored; ///< given, and stored in the scene
  FlagValues flags;  ///< those, and the preset's
  RenderOptions options;
  Input input; ///< of options.scene, opened
};
/// Throws Error: usage; input for a damaged scene or preset.
PictureRequest pictureRequest(const FlagValues& given);

/// Declares all results that `options` name, and enters all their inputs into the ledger. Throws
/// Error: usage or output.
void declareOutputs(const RenderOptions& options, Outputs& outputs);

/// Throws Error (output) if memory cannot hold the picture.
void checkMemory(const SceneRequest& scene);

/// Writes all of options.outputs; the caller commits them. Each header has the data that reproduce
/// the picture, `fenestra words…` among them. Throws Error (output).
void writePictures(const RenderOptions& options, const Scene& scene, const RenderResult& result,
                   const std::vector<std::string>& words, Outputs& outputs);

} // namespace fenestra
