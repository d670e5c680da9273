#pragma once
// One render on all MPI ranks. Each renders a shard of the image, and they join their films at the
// end of each pass. So all ranks see the same film, noise and sample plan, and decide alike.

#include "integrator/render/Render.h"
#include "ranks/Ranks.h"

namespace fenestra::core {

/// Makes render() on each rank render its part of settings.shard, from an image of `tiles`.
/// Requires the same scene, settings and resumed film on all ranks. Each rank gets the complete
/// film; rank 0 gets the counters of all and alone calls the given monitor.onPassEnd. Between two
/// passes a stop on one rank stops all; in the middle of one, relayStops() does.
void shareRender(const Ranks& ranks, const Tiles& tiles, RenderSettings& settings,
                 RenderMonitor& monitor);

} // namespace fenestra::core
