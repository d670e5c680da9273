#pragma once
// What becomes of a finished render on disk: checked before the long work, written after it.

#include "program/RenderFlags.h"
#include "session/Scene.h"

#include <future>

namespace fenestra {

/// Declares all that options name as results, and enters what they name as inputs into the ledger,
/// so that what cannot be written, or would replace an input, fails before the long work and not
/// after it. Throws Error: usage or output.
void declareOutputs(const RenderOptions& options, Outputs& outputs);

/// Throws Error (output) where memory cannot hold the picture.
void checkMemory(const SceneRequest& scene);

/// `fenestra arguments…` as a shell takes it back in the folder of the first picture, as seen from
/// which files are named.
std::string shellCommand(const std::vector<std::string>& arguments, const RenderOptions& options);

/// Writes options.surface, if it is wanted, while others work; the arguments must live until the
/// result is there, which throws Error (output).
std::future<void> startSurface(const RenderOptions& options, const Scene& scene, Outputs& outputs);

/// A warning for each file that belongs to one of options.outputs, was not written with it, and is
/// there: the depth beside a `.nrrd` that has none now. For after the commit.
std::vector<std::string> staleParts(const RenderOptions& options, const Outputs& outputs);

/// Writes all of options.outputs, each with `command` and whatever else repeats it in its header;
/// the caller commits them. Throws Error (output).
void writePictures(const RenderOptions& options, const Scene& scene, const RenderResult& result,
                   const std::string& command, Outputs& outputs);

} // namespace fenestra
