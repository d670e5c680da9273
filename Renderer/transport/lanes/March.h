#pragma once
// Expected first collisions of eye rays: March in SIMD lanes, a ray a lane.

#include "transport/lanes/PathTables.h"
#include "transport/lanes/Tracker.h"

namespace fenestra {

/// Rays, and FirstMatter of each, its distance from the ray's origin in the batch.
struct MarchBatch {
  RayBatch rays;
  Column<float> hit, distance;
  Columns3 albedo, normal, facing;
};

class WideMarch {
public:
  /// A view. The rays begin behind the clip's surface: a clip with a sharp edge is asked no more.
  WideMarch(const WideScene& volume, const EventScene& scene) : m_volume(volume), m_scene(scene) {}

  void along(MarchBatch& batch) const;
  /// result: transmittance of each ray, in coarser steps. These rays may begin anywhere.
  void through(RayBatch& rays) const;

private:
  const WideScene& m_volume;
  const EventScene& m_scene;
};

} // namespace fenestra
