#pragma once
// Traces batches of paths on a device. Several tracers work at the same time, each on its own queue
// where the device has several: while one tracer's host thread adds samples to the film, the device
// traces the paths of another. A path's sample depends on that path alone, so tracers and batches
// do not affect the image.

#include "base/StopFlag.h"
#include "integrator/gpu/BatchLimits.h"
#include "integrator/gpu/Pipeline.h"
#include "integrator/scalar/Counters.h"

namespace fenestra::core::gpu {

/// Result of one path, as Path.inl stores it. Paths that never scattered have the direction of
/// their camera ray instead of a normal, and `depth` is the distance to their collision.
struct PathResult {
  float radiance[3], scatterings;
  float albedo[3], depth;
  float normal[3], unused;
};

class BatchTracer {
public:
  /// Non-owning: the pipeline must outlive the tracer. Throws DeviceError.
  BatchTracer(const Pipeline& pipeline, std::size_t queue, const BatchLimits& limits);

  std::size_t maxPaths() const { return m_limits.paths; }
  /// The next batch's paths, to be filled before run().
  PathStart* starts() { return static_cast<PathStart*>(m_starts.mapped); }
  /// Traces the first `count` paths. Returns false if `stop` became true before all had ended.
  /// Throws DeviceError.
  bool run(std::size_t count, const StopFlag& stop, Counters& counters);
  /// Results of the last batch.
  const PathResult* results() const { return static_cast<const PathResult*>(m_results.mapped); }

private:
  /// WorkBuffer of PathTracer.comp.
  struct Work {
    std::int32_t nextPath;
    std::uint32_t unfinished;
    std::uint32_t counts[workKinds];
  };

  void bindBuffers();
  void recordBegin(VkCommandBuffer commands, std::size_t count) const;
  void recordDispatch(VkCommandBuffer commands, std::size_t count) const;
  void recordEnd(VkCommandBuffer commands, std::size_t count) const;
  void addCounts(Counters& counters) const;
  void adaptSteps(double seconds);

  const Pipeline& m_pipeline;
  std::size_t m_queue;
  BatchLimits m_limits;
  std::int32_t m_steps;
  Buffer m_starts, m_deviceStarts, m_results, m_deviceResults, m_states, m_work;
  Owned<VkDescriptorPool> m_descriptors;
  VkDescriptorSet m_set = VK_NULL_HANDLE;
  Commands m_commands;
};

} // namespace fenestra::core::gpu
