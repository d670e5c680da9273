#pragma once
// From a request to its results, for the commands that write a picture.

#include "program/Checkpoint.h"

#include <functional>

namespace fenestra {

/// Finds processes that help with a render, tells them of it, and puts them into its monitor;
/// empty: there are none.
using StartWorkers = std::function<void(const RenderOptions&, const PreparedScene&,
                                        const RenderSettings&, RenderMonitor&)>;

/// Renders the scene, from `checkpoint` on if there is one, puts its pictures in place, then
/// measures them for the statistics; of a part, puts its film in place. `words`: arguments of the
/// process, for the pictures' headers. Returns the exit status.
int renderScene(const RenderJob& job, const std::vector<std::string>& arguments,
                std::optional<Checkpoint>& checkpoint, Outputs& outputs,
                const StartWorkers& startWorkers = {});

/// The command `render`, with processes that help.
int runRender(const StartWorkers& startWorkers, int argc, char** argv, int first);

} // namespace fenestra
