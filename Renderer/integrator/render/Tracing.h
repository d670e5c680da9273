#pragma once
// The integrators as tracers of a pass's streams, and which of them renders a scene.

#include "base/InstructionSets.h"
#include "integrator/gpu/DeviceIntegrator.h"
#include "integrator/render/DeviceCheck.h"
#include "integrator/render/Render.h"
#include "integrator/render/TileStream.h"
#include "integrator/scalar/PathIntegrator.h"

#include <tbb/task_arena.h>

namespace fenestra::core {

/// Traces one path after another with the scalar integrator.
template <typename Voxel>
struct ScalarTracer {
  PathIntegrator<Voxel> integrator;

  template <typename Source>
  bool trace(Source& source, std::size_t maxPaths, Counters& counters) const {
    const auto samples = std::make_unique<CameraSamples>();
    do {
      source.fill(*samples, std::min(maxPaths, RayBatch::capacity));
      for (std::size_t i = 0; i < samples->size; ++i) {
        const PrimarySamples numbers =
            source.sampler().generate({samples->start[i], samples->key[i]}, samples->number[i]);
        const Vec2 point = toUniform2(numbers.position) + Vec2(samples->column[i], samples->row[i]);
        const std::optional<PathSample> sample =
            integrator.trace(point.x(), point.y(), numbers, counters);
        if (!sample)
          return false;
        source.deliver(samples->tile[i], samples->tileSample[i], *sample);
      }
    } while (samples->size > 0);
    return true;
  }
};

/// Streams of a pass that are traced at the same time, and how many paths each traces together.
struct Streams {
  int count;
  std::size_t maxPaths;
};
/// One per thread. Limits the paths, so that all threads get some and end at about the same time.
template <typename Tracer>
Streams planStreams(const Tracer&, const Film& film) {
  const int threads = tbb::this_task_arena::max_concurrency();
  return {threads,
          std::max<std::size_t>(64, film.pixelCount() / (4 * static_cast<std::size_t>(threads)))};
}
inline Streams planStreams(const gpu::DeviceIntegrator& tracer, const Film& film) {
  constexpr std::size_t least = std::size_t{1} << 14; // fewer leave a GPU idle
  return {static_cast<int>(tracer.tracerCount()),
          std::max(least, film.pixelCount() / tracer.tracerCount())};
}

template <typename Tracer>
void traceStream(const Tracer& tracer, int, TileStream& stream, std::size_t maxPaths,
                 Counters& counters) {
  tracer.trace(stream, maxPaths, counters);
}
inline void traceStream(const gpu::DeviceIntegrator& tracer, int index, TileStream& stream,
                        std::size_t maxPaths, Counters& counters) {
  tracer.trace(static_cast<std::size_t>(index), stream, maxPaths, counters);
}

/// Pixels that need only one sample: their camera rays meet no medium, and the background is
/// constant within each pixel.
inline EmptyPixels findEmptyPixels(const SceneView& scene, const RenderSettings& settings) {
  const bool isConstant = settings.path.background.kind != Background::Kind::environment ||
                          (!scene.lights.hasMaps() && scene.lights.tables().skies.empty());
  return isConstant ? EmptyPixels(scene.camera, scene.majorants) : EmptyPixels();
}

/// A scene as the SIMD integrator and the GPU read it.
struct SimdScene {
  SimdScene(const SceneView& scene, const RenderSettings& settings, const StopFlag& stop)
      : domain(scene.volume.grid, scene.crop),
        tracker(scene.volume, domain, scene.transfer, scene.majorants, scene.clip, scene.style,
                stop, scene.mixture),
        shading(scene.volume.grid, scene.transfer, scene.lights, settings.path.bounces,
                settings.path.wantNormals, scene.tint, scene.mixture),
        table(domain, scene.camera),
        cameraRays(scene.camera, cameraRayClip(scene.clip, scene.mixture), scene.lights,
                   settings.path.background) {}

  Domain domain;
  SimdTracker tracker;
  SimdShading shading;
  CameraTable table;
  CameraRays cameraRays;
};

/// Calls work(tracer, target) with the SIMD integrator.
template <typename Work>
auto traceSimd(const SceneView& scene, const RenderSettings& settings, const StopFlag& stop,
               Work&& work) {
  const SimdScene simd(scene, settings, stop);
  return work(SimdPathIntegrator(simd.tracker, simd.shading, simd.table, simd.cameraRays, stop),
              instructionSet());
}

/// Calls work(tracer, target) with the GPU.
template <typename Work>
auto traceGpu(const SceneView& scene, const RenderSettings& settings, const StopFlag& stop,
              Work&& work) {
  const std::shared_ptr<const gpu::Device> device = gpu::Device::open();
  const SimdScene simd(scene, settings, stop);
  const gpu::SceneTables tables(simd.tracker.medium(), simd.shading, simd.table, simd.cameraRays,
                                settings.sampling == Sampling::stratified);
  const gpu::DeviceIntegrator integrator(device, simd.tracker.medium(), tables, simd.table,
                                         simd.cameraRays, stop,
                                         settings.batchLimits.value_or(gpu::chooseLimits(*device)));
  checkDevice(integrator,
              SimdPathIntegrator(simd.tracker, simd.shading, simd.table, simd.cameraRays, stop),
              scene.camera, Sampler(settings.sampling, settings.seed));
  return work(integrator, device->info().target());
}

/// Calls work(tracer, target) with the scalar integrator.
template <typename Work>
auto traceScalar(const SceneView& scene, const RenderSettings& settings, const StopFlag& stop,
                 Work&& work) {
  const auto scalar = [&]<typename Voxel>(const Medium<Voxel>& medium,
                                          const Tracker<Voxel>& tracker) {
    return work(
        ScalarTracer<Voxel>{PathIntegrator<Voxel>(scene.volume.grid, medium, tracker, scene.lights,
                                                  scene.camera, scene.clip, settings.path, stop)},
        std::string("scalar"));
  };
  return withMedium(scene, scalar, stop);
}

inline bool isSimdUsed(const SceneView& scene, const RenderSettings& settings) {
  return settings.integrator != Integrator::scalar && canUseSimd(scene);
}

/// Calls work() in an arena of as many threads as the settings allow.
template <typename Work>
auto inArena(const RenderSettings& settings, Work&& work) {
  const int cores = tbb::info::default_concurrency(); // TBB warns about more
  tbb::task_arena arena(settings.threads > 0 ? std::min(settings.threads, cores) : cores);
  return arena.execute(work);
}

/// Calls work(tracer, target) with an integrator of the CPU.
template <typename Work>
auto traceScene(const SceneView& scene, const RenderSettings& settings, const StopFlag& stop,
                Work&& work) {
  return inArena(settings, [&] {
    return isSimdUsed(scene, settings) ? traceSimd(scene, settings, stop, work)
                                       : traceScalar(scene, settings, stop, work);
  });
}

} // namespace fenestra::core
