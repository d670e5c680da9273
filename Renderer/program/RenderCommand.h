#pragma once
// The render itself, from a job to its results, for the commands that write one image.

#include "program/Checkpoint.h"

#include <functional>

namespace fenestra::core {

/// Starts remote workers for a render and registers them in its monitor; empty: no workers. Keeps
/// MPI out of this library.
using StartWorkers = std::function<void(const RenderOptions&, const PreparedScene&,
                                        const RenderSettings&, RenderMonitor&)>;

/// Builds the scene, renders it (resuming from `checkpoint` if set), writes images, and measures
/// them for the statistics. For a shard, writes only the checkpoint file. `arguments`: command line
/// of the process, for the image headers. Returns the exit status.
int renderScene(const RenderJob& job, const std::vector<std::string>& arguments,
                std::optional<Checkpoint>& checkpoint, Outputs& outputs,
                const StartWorkers& startWorkers = {});

/// The command `render`, with remote workers.
int runRender(const StartWorkers& startWorkers, int argc, char** argv, int first);

} // namespace fenestra::core
