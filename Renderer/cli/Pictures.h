#pragma once
// What becomes of a finished render on disk: checked before the long work, written after it.

#include "cli/RenderFlags.h"
#include "scene/Scene.h"

#include <future>

namespace fenestra {

/// Fails before the long work, not after it: results that would replace an input or one another,
/// that cannot be written, or whose picture memory cannot hold. Throws Error (usage or output).
void checkOutputs(const RenderOptions& options);

/// `fenestra arguments…` as a shell takes it back.
std::string shellCommand(const std::vector<std::string>& arguments);

/// Writes options.surface, if it is wanted, while others work; both arguments must live until the
/// result is there, which throws Error (output).
std::future<void> startSurface(const RenderOptions& options, const Scene& scene);

/// All of options.outputs, each with `command` and whatever else repeats it in its header. Throws
/// Error (output).
void writePictures(const RenderOptions& options, const Scene& scene, const RenderResult& result,
                   const std::string& command);

} // namespace fenestra
