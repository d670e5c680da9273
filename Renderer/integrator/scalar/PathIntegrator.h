#pragma once
// Reference integrator: scalar, double precision, one path at a time. Unbiased; all faster
// integrators are tested against it.

#include "integrator/scalar/PathSteps.h"
#include "integrator/scalar/Tracker.h"

namespace fenestra::core {

/// `Distances` has the sampling functions of Tracker.
template <typename Voxel, typename Distances = Tracker<Voxel>>
class PathIntegrator {
public:
  /// Non-owning: all arguments must outlive the integrator.
  PathIntegrator(const Grid& grid, const Medium<Voxel>& medium, const Distances& tracker,
                 const LightSet& lights, const Camera& camera, const Clip& clip,
                 const PathSettings& settings, const StopFlag& stop)
      : m_steps(grid, medium, lights, camera, clip, settings), m_tracker(tracker), m_stop(stop) {}

  /// Traces one path through raster position (column, row). Empty if `stop` became true before the
  /// path ended: with albedo 1 in a dense medium a path can take minutes.
  std::optional<PathSample> trace(double column, double row, const PrimarySamples& numbers,
                                  Counters& counters) const {
    ++counters.paths;
    Path path = m_steps.begin(column, row, numbers);
    while (!PathSteps<Voxel>::hasEnded(path) && !isStopped()) {
      const double distance =
          m_tracker.sampleCollision(path.ray, path.range, path.uFlight, path.random, counters);
      if (!m_steps.handleVertex(path, distance))
        break;
      ++counters.collisions;
      const std::optional<ShadowRay> light = m_steps.scatter(path, distance, counters);
      if (!light)
        continue;
      ++counters.shadowRays;
      path.sample.radiance +=
          light->radiance *
          m_tracker.transmittance(light->ray, {0.0, light->distance}, path.random, counters);
    }
    return isStopped() ? std::nullopt : std::optional(path.sample);
  }

private:
  bool isStopped() const { return m_stop.load(std::memory_order_relaxed); }

  PathSteps<Voxel> m_steps;
  const Distances& m_tracker;
  const StopFlag& m_stop;
};

} // namespace fenestra::core
