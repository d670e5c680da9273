#include "integrator/gpu/DeviceIntegrator.h"

#include <cmath>

namespace fenestra::core::gpu {
namespace {

/// Two tracers suffice to overlap the work of host and device; more help devices with several
/// queues.
std::size_t chooseTracerCount(const Device& device) {
  return std::max<std::size_t>(2, device.queueCount());
}

} // namespace

BatchLimits chooseLimits(const Device& device) {
  // Mesa's software device ends all loops of a dispatch after 65,535 iterations in total, and a
  // step through an exact surface takes hundreds.
  if (device.isSoftware())
    return {.threads = 1024, .paths = std::size_t{1} << 13, .maxSteps = 16};
  // All tracers together keep half a million threads busy.
  const std::uint32_t threads = (1U << 19) / static_cast<std::uint32_t>(chooseTracerCount(device));
  return {.threads = threads / 64 * 64, .paths = std::size_t{2} * threads};
}

DeviceIntegrator::DeviceIntegrator(std::shared_ptr<const Device> device, const SimdMedium& medium,
                                   const SceneTables& scene, const CameraTable& camera,
                                   const CameraRays& cameraRays, const StopFlag& stop,
                                   const BatchLimits& limits)
    : m_pipeline(std::move(device), medium, scene),
      m_nearDepth(camera.nearDepth),
      m_cameraRays(cameraRays),
      m_stop(stop) {
  const Device& on = m_pipeline.device();
  for (std::size_t i = 0; i < chooseTracerCount(on); ++i)
    m_tracers.push_back(std::make_unique<BatchTracer>(m_pipeline, i % on.queueCount(), limits));
}

/// Appends paths after those of `destinations`.
void DeviceIntegrator::append(const CameraSamples& samples, PathStart* starts,
                              std::vector<Destination>& destinations) {
  PathStart* next = starts + destinations.size();
  for (std::size_t i = 0; i < samples.size; ++i) {
    *next++ = {static_cast<Int>(samples.column[i]), static_cast<Int>(samples.row[i]),
               samples.start[i], samples.key[i], samples.number[i]};
    destinations.push_back({samples.tile[i], samples.tileSample[i], samples.row[i]});
  }
}

PathSample DeviceIntegrator::makeSample(const PathResult& result, float row) const {
  const auto triple = [](const float(&v)[3]) {
    return Rgb(double{v[0]}, double{v[1]}, double{v[2]});
  };
  if (result.scatterings == 0.0F) // escaped, or collided with scatterings limited to 0
    return std::isinf(result.depth)
               ? m_cameraRays.sampleBackground(double{row}, triple(result.normal).matrix())
               : PathSample{};
  PathSample sample;
  sample.radiance = triple(result.radiance);
  sample.albedo = triple(result.albedo);
  sample.normal = triple(result.normal).matrix();
  sample.depth = m_nearDepth + double{result.depth};
  sample.scatterings = double{result.scatterings};
  return sample;
}

} // namespace fenestra::core::gpu
