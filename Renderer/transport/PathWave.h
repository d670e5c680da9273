#pragma once
// Many paths at once, for speed: all of a batch fly, then all scatter, then all look at their
// lights, and paths that have ended make room for new ones. Events are PathSteps'; distances come
// from WideTracker. A path depends on its own random numbers alone, so its sample is the same
// whichever others it travels with.

#include "tracking/WideTracker.h"
#include "transport/PathSteps.h"
#include "volume/Domain.h"

#include <atomic>
#include <vector>

namespace fenestra {

/// Where a path begins: raster position, and its random numbers from there on.
struct PathStart {
  double column, row;
  Random random;
};

template <typename Voxel>
class PathWave {
public:
  /// A view of all that it is given.
  PathWave(const Domain& domain, const Medium<Voxel>& medium, const WideTracker& tracker,
           const LightSet& lights, const Camera& camera, const Clip& clip,
           const PathSettings& settings, const std::atomic<bool>& stop)
      : m_domain(domain),
        m_steps(domain.grid(), medium, lights, camera, clip, settings),
        m_tracker(tracker),
        m_stop(stop) {}

  /// Traces paths start(0) … start(count - 1), and hands in deliver(i, sample) of each, in any
  /// order. Returns false where `stop` became true before all had ended.
  template <typename Start, typename Deliver>
  bool trace(std::size_t count, Start&& start, Deliver&& deliver, Counters& counters) const {
    counters.paths += count;
    Batch batch;
    for (std::size_t next = 0; next < count || !batch.paths.empty();) {
      if (m_stop.load(std::memory_order_relaxed))
        return false;
      for (; next < count && batch.paths.size() < RayBatch::capacity; ++next) {
        const PathStart from = start(next);
        batch.paths.push_back({m_steps.begin(from.column, from.row, from.random), next});
      }
      fly(batch, counters);
      scatter(batch, counters);
      look(batch, counters);
      std::erase_if(batch.paths, [&](const Numbered& path) {
        if (path.going)
          return false;
        deliver(path.number, path.path.sample);
        return true;
      });
    }
    return true;
  }

private:
  struct Numbered {
    Path path;
    std::size_t number;
    bool going = true;
    double begin = 0.0; ///< mm along its ray to where the batch's ray begins
  };
  struct Light {
    std::size_t path; ///< of the batch
    ShadowRay ray;
  };
  struct Batch {
    std::vector<Numbered> paths;
    std::vector<Light> lights; ///< that the paths sampled
    RayBatch rays;             ///< the paths', then the lights'
  };

  double add(RayBatch& rays, const Ray& ray, const Interval& range, Random& random) const {
    return addInside(rays, m_domain, ray, range, static_cast<std::uint32_t>(random.bits() >> 32));
  }

  void fly(Batch& batch, Counters& counters) const {
    batch.rays.size = 0;
    for (Numbered& path : batch.paths)
      path.begin = add(batch.rays, path.path.ray, path.path.range, path.path.random);
    m_tracker.sampleCollisions(batch.rays, counters);
  }

  void scatter(Batch& batch, Counters& counters) const {
    batch.lights.clear();
    for (std::size_t i = 0; i < batch.paths.size(); ++i) {
      Numbered& path = batch.paths[i];
      const double distance = path.begin + static_cast<double>(batch.rays.result[i]);
      path.going = m_steps.arrive(path.path, distance);
      if (!path.going)
        continue;
      ++counters.collisions;
      if (const std::optional<ShadowRay> light = m_steps.scatter(path.path, distance))
        batch.lights.push_back({i, *light});
      path.going = !PathSteps<Voxel>::ended(path.path);
    }
  }

  void look(Batch& batch, Counters& counters) const {
    batch.rays.size = 0;
    for (const Light& light : batch.lights)
      add(batch.rays, light.ray.ray, {0.0, light.ray.distance},
          batch.paths[light.path].path.random);
    m_tracker.estimateTransmittances(batch.rays, counters);
    for (std::size_t i = 0; i < batch.lights.size(); ++i) {
      const Light& light = batch.lights[i];
      batch.paths[light.path].path.sample.radiance +=
          light.ray.radiance * static_cast<double>(batch.rays.result[i]);
    }
  }

  Domain m_domain;
  PathSteps<Voxel> m_steps;
  const WideTracker& m_tracker;
  const std::atomic<bool>& m_stop;
};

} // namespace fenestra
