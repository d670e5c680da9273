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
    std::size_t next = 0;
    const auto begun = [&] {
      const PathStart from = start(next);
      return Slot{m_steps.begin(from.column, from.row, from.random), next++};
    };
    while (next < count && batch.slots.size() < RayBatch::capacity)
      batch.slots.push_back(begun());
    for (;;) {
      if (m_stop.load(std::memory_order_relaxed))
        return false;
      fly(batch, counters);
      if (batch.flying.empty())
        return true;
      scatter(batch, counters);
      look(batch, counters);
      for (Slot* slot : batch.flying) {
        if (slot->going)
          continue;
        deliver(slot->number, slot->path.sample);
        if (next < count)
          *slot = begun();
      }
    }
  }

private:
  /// A place for a path; the next one takes it when the path has ended.
  struct Slot {
    Path path;
    std::size_t number;
    bool going = true;
    double begin = 0.0; ///< mm along its ray to where the batch's ray begins
  };
  struct Light {
    Slot* slot;
    ShadowRay ray;
  };
  struct Batch {
    std::vector<Slot> slots;
    std::vector<Slot*> flying; ///< whose paths are on their way
    std::vector<Light> lights; ///< that those sampled
    RayBatch rays;             ///< the paths', then the lights'
  };

  double add(RayBatch& rays, const Ray& ray, const Interval& range, Random& random) const {
    return addInside(rays, m_domain, ray, range, static_cast<std::uint32_t>(random.bits() >> 32));
  }

  void fly(Batch& batch, Counters& counters) const {
    batch.rays.size = 0;
    batch.flying.clear();
    for (Slot& slot : batch.slots)
      if (slot.going) {
        slot.begin = add(batch.rays, slot.path.ray, slot.path.range, slot.path.random);
        batch.flying.push_back(&slot);
      }
    m_tracker.sampleCollisions(batch.rays, counters);
  }

  void scatter(Batch& batch, Counters& counters) const {
    batch.lights.clear();
    for (std::size_t i = 0; i < batch.flying.size(); ++i) {
      Slot& slot = *batch.flying[i];
      const double distance = slot.begin + static_cast<double>(batch.rays.result[i]);
      slot.going = m_steps.arrive(slot.path, distance);
      if (!slot.going)
        continue;
      ++counters.collisions;
      if (const std::optional<ShadowRay> light = m_steps.scatter(slot.path, distance))
        batch.lights.push_back({&slot, *light});
      slot.going = !PathSteps<Voxel>::ended(slot.path);
    }
  }

  void look(Batch& batch, Counters& counters) const {
    batch.rays.size = 0;
    for (const Light& light : batch.lights)
      add(batch.rays, light.ray.ray, {0.0, light.ray.distance}, light.slot->path.random);
    m_tracker.estimateTransmittances(batch.rays, counters);
    for (std::size_t i = 0; i < batch.lights.size(); ++i) {
      const Light& light = batch.lights[i];
      light.slot->path.sample.radiance +=
          light.ray.radiance * static_cast<double>(batch.rays.result[i]);
    }
  }

  Domain m_domain;
  PathSteps<Voxel> m_steps;
  const WideTracker& m_tracker;
  const std::atomic<bool>& m_stop;
};

} // namespace fenestra
