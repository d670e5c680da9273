#pragma once
// Expected first collisions of eye rays: March in SIMD lanes, a ray a lane.

#include "integrator/simd/Shading.h"
#include "integrator/simd/Tracker.h"

namespace fenestra {

/// Rays, and ExpectedHit of each, its distance from the ray's origin in the batch.
struct MarchBatch {
  RayBatch rays;
  SoaArray<float> hit, distance;
  SoaArray3 albedo, normal, surfaceNormal;
};

/// Marches eye rays that begin behind the clip's surface: a clip with a sharp edge is asked no
/// more.
void marchCameraRays(const SimdMedium& medium, const SimdShading& shading, MarchBatch& batch);

/// result: transmittance of each ray, in coarser steps. These rays may begin anywhere.
void marchShadowRays(const SimdMedium& medium, RayBatch& rays);

} // namespace fenestra
