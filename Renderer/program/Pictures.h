#pragma once
// Way of a picture, the same for render, serve and turntable: request, scene, render, files. Files
// are checked before the long work, and written after it.

#include "program/PresetFlags.h"
#include "session/Scene.h"

#include <future>

namespace fenestra {

/// Throws Error (usage) for a given flag of these, which the command does not take; `why`: the rest
/// of the message.
void refuseFlags(const FlagValues& given, std::initializer_list<const char*> names,
                 const std::string& why);

struct PictureRequest {
  FlagValues stored; ///< given, and stored in the scene
  FlagValues flags;  ///< those, and the preset's
  RenderOptions options;
  Input input; ///< of options.scene, opened
};
/// Throws Error: usage; input for a damaged scene or preset.
PictureRequest pictureRequest(const FlagValues& given);

/// Declares all results that `options` name and enters all their inputs into the ledger: a file
/// that cannot be written, or a result that would replace an input, fails before the long work.
/// Throws Error: usage or output.
void declareOutputs(const RenderOptions& options, Outputs& outputs);

/// Throws Error (output) if memory cannot hold the picture.
void checkMemory(const SceneRequest& scene);

RenderResult renderPicture(const RenderOptions& options, const Scene& scene,
                           RenderMonitor& monitor);

/// Starts writing options.surface, if set, in parallel to other work. The arguments must outlive
/// the future; its get() throws Error (output).
std::future<void> startSurface(const RenderOptions& options, const Scene& scene, Outputs& outputs);

/// A warning for each existing file that belongs to one of options.outputs and was not written with
/// it, such as the old depth beside a `.nrrd` that has no depth now. For after the commit.
std::vector<std::string> staleParts(const RenderOptions& options, const Outputs& outputs);

/// Writes all of options.outputs; the caller commits them. Each header has the data that reproduce
/// the picture, `fenestra words…` among them. Throws Error (output).
void writePictures(const RenderOptions& options, const Scene& scene, const RenderResult& result,
                   const std::vector<std::string>& words, Outputs& outputs);

} // namespace fenestra
