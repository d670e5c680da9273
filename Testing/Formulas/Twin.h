#pragma once
// The twin: a small integrator of the shared formulas in float, one lane, with nothing contracted.
// It shows that they hold without SIMD and without double, as a GPU needs them.

#include "integrator/render/Render.h"

namespace fenestra::core::twin {

/// Renders a volume without clip, crop, surfaces, labels and environment maps. Deterministic.
Film render(const SceneView& scene, std::uint64_t samples, std::uint64_t seed);

} // namespace fenestra::core::twin
