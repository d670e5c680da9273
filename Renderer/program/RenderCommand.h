#pragma once
// The render itself, from a job to its results, for the commands that write one image.

#include "program/Checkpoint.h"

#include <functional>

namespace fenestra::core {

/// Makes other processes render other shards of the image, by changes to settings and monitor;
/// empty: this process alone renders. Keeps MPI out of this library.
using ShareRender = std::function<void(const RenderOptions&, const PreparedScene&, RenderSettings&,
                                       RenderMonitor&)>;

/// Builds the scene, renders it (resuming from `checkpoint` if set), writes images, and measures
/// them for the statistics. For a shard, writes only the checkpoint file. `arguments`: command line
/// of the process, for the image headers. Returns the exit status.
int renderScene(const RenderJob& job, const std::vector<std::string>& arguments,
                std::optional<Checkpoint>& checkpoint, Outputs& outputs,
                const ShareRender& share = {});

/// The command `render`, shared with other processes.
int runRender(const ShareRender& share, int argc, char** argv, int first);

} // namespace fenestra::core
