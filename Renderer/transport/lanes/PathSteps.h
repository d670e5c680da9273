#pragma once
// PathSteps' events for many paths at once, in SIMD lanes and float. The instruction
// set is chosen when the program runs (Highway).

#include "transport/lanes/PathTables.h"
#include "transport/lanes/Tracker.h"
#include "transport/readable/PathSteps.h"

namespace fenestra {

/// Paths under way: what `Path` holds for one, as a structure of arrays.
struct PathBatch {
  RayBatch rays;      ///< that they travel next, and where they collide
  Columns3 direction; ///< of their rays, world axes, unit
  Columns3 weight, radiance;
  Column<float> scatterPdf;
  Column<std::int32_t> bounces;
  Column<std::uint32_t> key, counter; ///< of their random numbers

  /// Values at the first collision.
  Column<float> firstDistance;
  Columns3 firstAlbedo, firstNormal;

  std::size_t endedCount = 0;
  Column<std::uint32_t> ended; ///< which of them

  /// Path i begins; its ray is set by the caller.
  void begin(std::size_t i, const Vec3& worldDirection, std::uint64_t randomBits);
  /// Path `to` becomes what path `from` is.
  void move(std::size_t from, std::size_t to);
};

/// Light on its way to paths: `radiance` arrives, times the transmittance of the ray.
struct LightBatch {
  RayBatch rays;
  Columns3 radiance;
  Column<std::uint32_t> path;
};

/// A view: what it is made of outlives it.
class WideEvents {
public:
  WideEvents(const WideScene& volume, EventScene scene)
      : m_volume(volume), m_scene(std::move(scene)) {}

  /// All paths have flown to their next collision, or out. Gathers what their rays met, samples a
  /// light for each that goes on (all of `lights`), and sets their new rays; says which have ended.
  void scatter(PathBatch& paths, LightBatch& lights, Counters& counters) const;

private:
  const WideScene& m_volume;
  EventScene m_scene;
};

} // namespace fenestra
