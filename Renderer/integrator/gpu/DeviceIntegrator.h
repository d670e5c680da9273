#pragma once
// Path integrator on a GPU: the paths of the SIMD integrator, in a compute shader.

#include "integrator/gpu/BatchTracer.h"
#include "integrator/simd/CameraRays.h"

namespace fenestra::core::gpu {

/// Limits that suit a device.
BatchLimits chooseLimits(const Device& device);

class DeviceIntegrator {
public:
  /// Non-owning: camera rays and stop must outlive the integrator. The scene must be supported
  /// (SceneTables). Throws DeviceError.
  DeviceIntegrator(std::shared_ptr<const Device> device, const SimdMedium& medium,
                   const SceneTables& scene, const CameraTable& camera,
                   const CameraRays& cameraRays, const StopFlag& stop, const BatchLimits& limits);

  /// Batches that can be traced at the same time, each by a thread of its own.
  std::size_t tracerCount() const { return m_tracers.size(); }

  /// Traces all paths of source.fill(samples, maxCount), at most `maxPaths` at a time, and calls
  /// source.deliver(tile, tileSample, sample) for each. Returns false if `stop` became true before
  /// all had ended. Throws DeviceError.
  template <typename Source>
  bool trace(std::size_t tracer, Source& source, std::size_t maxPaths, Counters& counters) const {
    BatchTracer& device = *m_tracers[tracer];
    const std::size_t most = std::min(maxPaths, device.maxPaths());
    const auto samples = std::make_unique<CameraSamples>();
    std::vector<Destination> destinations;
    for (;;) {
      destinations.clear();
      do {
        source.fill(*samples, std::min(most - destinations.size(), RayBatch::capacity));
        append(*samples, device.starts(), destinations);
      } while (samples->size > 0 && destinations.size() < most);
      if (destinations.empty())
        return true;
      if (!device.run(destinations.size(), m_stop, counters))
        return false;
      const PathResult* result = device.results();
      for (const Destination& to : destinations)
        source.deliver(to.tile, to.tileSample, makeSample(*result++, to.row));
    }
  }

private:
  /// What becomes of a path's sample.
  struct Destination {
    std::uint32_t tile, tileSample;
    float row; ///< of the pixel
  };

  static void append(const CameraSamples& samples, PathStart* starts,
                     std::vector<Destination>& destinations);
  PathSample makeSample(const PathResult& result, float row) const;

  Pipeline m_pipeline;
  std::vector<std::unique_ptr<BatchTracer>> m_tracers;
  double m_nearDepth; ///< CameraTable::nearDepth
  const CameraRays& m_cameraRays;
  const StopFlag& m_stop;
};

} // namespace fenestra::core::gpu
