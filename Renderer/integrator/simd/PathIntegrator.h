#pragma once
// SIMD path integrator. All paths of a batch sample their collisions, then scatter, then trace
// shadow rays; new paths replace those that have ended. A path depends on its own random numbers
// alone, so its sample does not depend on the other paths of the batch.

#include "integrator/simd/CameraRays.h"
#include "integrator/simd/PathSteps.h"

#include <bit>
#include <memory>

namespace fenestra::core {

class SimdPathIntegrator {
public:
  /// Non-owning: all arguments must outlive the integrator. The tracker must have the same `stop`:
  /// it leaves paths unfinished, which are discarded here.
  SimdPathIntegrator(const SimdTracker& tracker, const SimdShading& shading,
                     const CameraTable& table, const CameraRays& cameraRays, const StopFlag& stop)
      : m_tracker(tracker),
        m_shading(shading),
        m_table(table),
        m_cameraRays(cameraRays),
        m_stop(stop) {}

  /// Traces all paths of source.fill(samples, maxCount), at most `maxPaths` at a time, and calls
  /// source.deliver(tile, tileSample, sample) for each, in any order. Returns false if `stop`
  /// became true before all had ended.
  template <typename Source>
  bool trace(Source& source, std::size_t maxPaths, Counters& counters) const {
    const auto batch = std::make_unique<Batch>();
    const std::size_t most = std::min(maxPaths, RayBatch::capacity);
    for (;;) {
      source.fill(batch->samples, most - batch->paths.rays.size);
      counters.paths += batch->samples.size;
      beginPaths(m_tracker.medium(), m_table, m_cameraRays, batch->samples, batch->paths);
      if (batch->paths.rays.size == 0)
        return true;
      m_tracker.sampleCollisions(batch->paths.rays, counters);
      if (isStopped())
        return false;
      scatterPaths(m_tracker.medium(), m_shading, batch->paths, batch->shadowRays, counters);
      traceShadowRays(*batch, counters);
      if (isStopped())
        return false;
      deliverEnded(batch->paths, source);
      dropEnded(batch->paths);
    }
  }

private:
  bool isStopped() const { return m_stop.load(std::memory_order_relaxed); }

  struct Batch {
    CameraSamples samples;
    PathBatch paths;
    ShadowBatch shadowRays;
  };

  void traceShadowRays(Batch& batch, Counters& counters) const {
    ShadowBatch& shadowRays = batch.shadowRays;
    m_tracker.estimateTransmittances(shadowRays.rays, counters);
    for (std::size_t i = 0; i < shadowRays.rays.size; ++i)
      for (std::size_t c = 0; c < 3; ++c)
        batch.paths.radiance[c][shadowRays.path[i]] +=
            shadowRays.radiance[c][i] * shadowRays.rays.result[i];
  }

  template <typename Source>
  void deliverEnded(const PathBatch& paths, Source& source) const {
    for (std::size_t first = 0; first < paths.rays.size; first += 64)
      for (std::uint64_t left = paths.ended[first / 64]; left != 0; left &= left - 1) {
        const std::size_t i = first + static_cast<std::size_t>(std::countr_zero(left));
        source.deliver(paths.tile[i], paths.tileSample[i], makeSample(paths, i));
      }
  }

  PathSample makeSample(const PathBatch& paths, std::size_t i) const {
    const auto triple = [&](const SoaArray3& columns) {
      return Rgb(columns[0][i], columns[1][i], columns[2][i]);
    };
    if (paths.bounces[i] == 0) // escaped, or collided with scatterings limited to 0
      return std::isinf(paths.rays.result[i])
                 ? m_cameraRays.sampleBackground(double{paths.row[i]},
                                                 triple(paths.cameraDirection).matrix())
                 : PathSample{};
    PathSample sample;
    sample.radiance = triple(paths.radiance);
    sample.albedo = triple(paths.firstAlbedo);
    sample.normal = triple(paths.firstNormal).matrix();
    sample.depth = m_table.nearDepth + double{paths.firstDepth[i]};
    sample.scatterings = static_cast<double>(paths.bounces[i]);
    return sample;
  }

  const SimdTracker& m_tracker;
  const SimdShading& m_shading;
  const CameraTable& m_table;
  const CameraRays& m_cameraRays;
  const StopFlag& m_stop;
};

} // namespace fenestra::core
