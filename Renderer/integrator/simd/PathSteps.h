#pragma once
// Events of many paths at once: PathSteps in SIMD lanes, in float. The instruction set is chosen at
// run time (Highway).

#include "integrator/scalar/PathSteps.h"
#include "integrator/simd/PathBatch.h"
#include "integrator/simd/Shading.h"

namespace fenestra {

/// Light sampled for paths: `radiance` times the transmittance of the ray arrives at `path`.
struct ShadowBatch {
  RayBatch rays;
  SoaArray3 radiance;
  SoaArray<std::uint32_t> path;
};

/// Handles the paths' collisions and escapes (rays.result): gathers the light met by the rays,
/// replaces `lights` by one light for each path that scatters, sets new rays, and marks the paths
/// that have ended.
void scatterPaths(const SimdMedium& medium, const SimdShading& shading, PathBatch& paths,
                  ShadowBatch& shadowRays, Counters& counters);

/// Takes the paths that have ended out of the batch.
void dropEnded(PathBatch& paths);

} // namespace fenestra
