#pragma once
// The twin: the text of the GPU's shader, compiled as C++ in float, one path after another, with
// nothing contracted. On a device that rounds each operation to nearest, the GPU has its bits.

#include "integrator/gpu/Layout.h"
#include "integrator/render/Render.h"

namespace fenestra::core::twin {

struct Result {
  Film film;
  Counters counters = {};
  gpu::Features features = {};
};

/// Renders settings.samples per pixel. The scene must be one that the GPU supports. Other limits,
/// threads and passes of the settings are ignored.
Result render(const SceneView& scene, const RenderSettings& settings);

} // namespace fenestra::core::twin
