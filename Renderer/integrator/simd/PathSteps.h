#pragma once
// Vertices of many paths at once: SIMD version of PathSteps, in float. Highway selects the
// instruction set at run time.

#include "integrator/scalar/PathSteps.h"
#include "integrator/simd/PathBatch.h"
#include "integrator/simd/Shading.h"

namespace fenestra::core {

/// Shadow rays: `radiance` times the transmittance of a ray is added to `path`.
struct ShadowBatch {
  RayBatch rays;
  SoaArray3 radiance;
  SoaArray<std::uint32_t> path;
};

/// Handles the paths' collisions and escapes (rays.result): adds the light emitted along the rays,
/// replaces `shadowRays` by one per path that scatters and samples a light, sets the next rays, and
/// marks the paths that have ended.
void scatterPaths(const SimdMedium& medium, const SimdShading& shading, PathBatch& paths,
                  ShadowBatch& shadowRays, Counters& counters);

/// Removes ended paths from the batch; the others move up, so that there are no gaps.
void dropEnded(PathBatch& paths);

} // namespace fenestra::core
