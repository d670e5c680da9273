#pragma once
// Events of many paths at once: PathSteps in SIMD lanes, in float. The instruction set is chosen at
// run time (Highway).

#include "transport/lanes/PathBatch.h"
#include "transport/lanes/PathTables.h"
#include "transport/readable/PathSteps.h"

namespace fenestra {

/// Light sampled for paths: `radiance` times the transmittance of the ray arrives at `path`.
struct LightBatch {
  RayBatch rays;
  Columns3 radiance;
  Column<std::uint32_t> path;
};

/// A view: `volume`, and the maps of `scene`, must outlive the object.
class WideEvents {
public:
  WideEvents(const WideScene& volume, EventScene scene)
      : m_volume(volume), m_scene(std::move(scene)) {}

  /// Handles the paths' collisions and escapes (rays.result): gathers the light met by the rays,
  /// replaces `lights` by one light for each path that scatters, sets new rays, and marks the paths
  /// that have ended.
  void scatter(PathBatch& paths, LightBatch& lights, Counters& counters) const;

private:
  const WideScene& m_volume;
  EventScene m_scene;
};

/// Takes the paths that have ended out of the batch.
void dropEnded(PathBatch& paths);

} // namespace fenestra
