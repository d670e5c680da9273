#pragma once
// Events of many paths at once: PathSteps in SIMD lanes, in float. The instruction set is chosen at
// run time (Highway).

#include "transport/lanes/PathTables.h"
#include "transport/lanes/Tracker.h"
#include "transport/readable/PathSteps.h"

namespace fenestra {

/// Paths under way: `Path` as a structure of arrays.
struct PathBatch {
  RayBatch rays;      ///< next rays, and their collisions
  Columns3 direction; ///< of the rays, world axes, unit
  Columns3 weight, radiance;
  Column<float> scatterPdf;
  Column<std::int32_t> bounces;
  Column<std::uint32_t> key, counter;     ///< of the paths' random numbers
  std::array<Column<float>, 2> scattered; ///< numbers of the first scattered directions

  /// First collision.
  Column<float> firstDistance;
  Columns3 firstAlbedo, firstNormal;

  std::size_t endedCount = 0;
  Column<std::uint32_t> ended; ///< indices of the ended paths

  /// Begins path i; the caller sets its ray.
  void begin(std::size_t i, const Vec3& worldDirection, const Vec2& scatteredNumbers,
             std::uint64_t randomBits);
  /// Copies path `from` to path `to`.
  void move(std::size_t from, std::size_t to);
};

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
  /// replaces `lights` by one light for each path that scatters, sets new rays, and lists the paths
  /// that have ended.
  void scatter(PathBatch& paths, LightBatch& lights, Counters& counters) const;

private:
  const WideScene& m_volume;
  EventScene m_scene;
};

} // namespace fenestra
