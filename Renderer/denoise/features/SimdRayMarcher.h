#pragma once
// Expected first collisions of camera rays: RayMarcher in SIMD, one ray per lane.

#include "integrator/simd/Shading.h"
#include "integrator/simd/Tracker.h"

namespace fenestra::core {

/// Rays, and the ExpectedHit of each; distances count from the ray's origin in the batch.
struct MarchBatch {
  RayBatch rays;
  SoaArray<float> hit, distance, distance50;
  SoaArray3 albedo, normal, surfaceNormal;
};

/// Marches camera rays that start behind the clip's surface: a sharp edge is not evaluated again.
void marchCameraRays(const SimdMedium& medium, const SimdShading& shading, MarchBatch& batch);

/// result: transmittance of each ray, in coarser steps. These rays may start anywhere.
void marchShadowRays(const SimdMedium& medium, RayBatch& rays);

} // namespace fenestra::core
