#pragma once
// Files of a finished render: checked before the long work, written after it.

#include "program/RenderFlags.h"
#include "session/Scene.h"

#include <future>

namespace fenestra {

/// Declares all results that `options` name and enters all their inputs into the ledger: a file
/// that cannot be written, or a result that would replace an input, fails before the long work.
/// Throws Error: usage or output.
void declareOutputs(const RenderOptions& options, Outputs& outputs);

/// Throws Error (output) if memory cannot hold the picture.
void checkMemory(const SceneRequest& scene);

/// `fenestra arguments…`, quoted for a shell, with files named relative to the folder of the first
/// picture.
std::string shellCommand(const std::vector<std::string>& arguments, const RenderOptions& options);

/// Starts writing options.surface, if set, in parallel to other work. The arguments must outlive
/// the future; its get() throws Error (output).
std::future<void> startSurface(const RenderOptions& options, const Scene& scene, Outputs& outputs);

/// A warning for each existing file that belongs to one of options.outputs and was not written with
/// it, such as the old depth beside a `.nrrd` that has no depth now. For after the commit.
std::vector<std::string> staleParts(const RenderOptions& options, const Outputs& outputs);

/// Writes all of options.outputs, with `command` and the other data that reproduce the picture in
/// each header; the caller commits them. Throws Error (output).
void writePictures(const RenderOptions& options, const Scene& scene, const RenderResult& result,
                   const std::string& command, Outputs& outputs);

} // namespace fenestra
