#pragma once
// Renders a prepared scene to a film, in passes, up to a limit of samples, time or noise. The voxel
// type is resolved once, in withMedium; everything below it is a template. Samples are a function
// of (seed, pixel, sample index) and each pixel adds its samples in order, so the image depends
// neither on threads nor on passes nor on interruptions.

#include "image/Film.h"
#include "image/Tiles.h"
#include "integrator/gpu/BatchLimits.h"
#include "integrator/render/SamplePlan.h"
#include "integrator/scalar/Counters.h"
#include "integrator/scalar/MajorantGrid.h"
#include "integrator/scalar/PathIntegrator.h"
#include "model/lights/LightSet.h"
#include "model/volume/Domain.h"
#include "model/volume/Volume.h"

#include <atomic>
#include <chrono>
#include <functional>
#include <string>

namespace fenestra::core {

/// Inputs of the integrators. Non-owning: all referenced objects must outlive the render.
struct SceneView {
  const Volume& volume;
  const TransferFunction& transfer;
  const MajorantGrid& majorants;
  const LightSet& lights;
  const Camera& camera;
  const Clip& clip;
  std::optional<CropBox> crop = {};
  const ContextStyle* style = nullptr; ///< null: context is not restyled
  const Tint* tint = nullptr;          ///< of segments; null: none
  const Mixture* mixture = nullptr;    ///< of segments, instead of a tint; null: none
};

/// Calls work(medium, tracker) for the volume's storage type.
template <typename Work>
auto withMedium(const SceneView& scene, Work&& work, const StopFlag& stop = neverStopped) {
  return std::visit(
      [&](const auto& voxels) {
        using Voxel = typename std::decay_t<decltype(voxels)>::value_type;
        const Medium<Voxel> medium(scene.volume.grid, voxels, scene.transfer, scene.style,
                                   scene.tint, scene.mixture);
        const Tracker<Voxel> tracker(Domain(scene.volume.grid, scene.crop), medium, scene.majorants,
                                     scene.clip, stop);
        return work(medium, tracker);
      },
      scene.volume.voxels);
}

/// All are unbiased. `gpu` falls back to `simd`, and `simd` to `scalar`, for scenes that they do
/// not support; `gpu` also without a device.
enum class Integrator { simd, scalar, gpu };

/// A render stops at the first of the limits. With a noise target for the raw image, noisier pixels
/// get more samples, after a pilot of 16 per pixel (SamplePlan). Otherwise all get the same number.
struct RenderSettings {
  PathSettings path;
  std::uint64_t samples = 64; ///< limit of the mean number per pixel
  double seconds = infinity;  ///< limit of the rendering time
  double noise = -1.0; ///< limit of Film::noise() after a pass, from 16 samples on; negative: none
  /// `noise` limits PassEnd::displayNoise instead, estimated at 4, 8, 16, ... samples only, so that
  /// a low estimate by chance is unlikely to end the render.
  bool isDisplayNoise = false;
  std::uint64_t seed = 0;
  Sampling sampling = Sampling::stratified;
  Integrator integrator = Integrator::simd;
  int threads = 0; ///< 0: all
  // Passes do not affect the image.
  std::uint64_t passSamples = 0; ///< per pass; 0: growing passes
  std::uint64_t passGrowth = 3;  ///< samples of a growing pass per sample before it
  double passSeconds = infinity; ///< limit of a pass's time, at the speed of the last one
  std::optional<gpu::BatchLimits> batchLimits = {}; ///< of the GPU; none: as the device suggests
  /// Tiles to render. The others stay as they are, so `noise` needs an onPassEnd that adds them.
  Shard shard = {};

  /// True if noisier pixels get more samples after the pilot.
  bool isAdaptive() const { return noise > 0.0 && !isDisplayNoise; }
};

/// How a pass ended, and what the next one depends on.
struct PassEnd {
  bool isComplete;              ///< false: the render was stopped before all tiles were finished
  std::uint64_t maxNextSamples; ///< per pixel in the next pass, by the limits of time; 0: it ends
  bool isNoiseDue;              ///< displayNoise is needed
  double displayNoise;          ///< estimated noise of the display image; infinity: unknown
};

struct RenderResult;

/// Progress of a running render, and its stop flag.
struct RenderMonitor {
  using Clock = std::chrono::steady_clock;

  std::atomic<bool> stop = false;
  std::atomic<std::uint64_t> paths = 0; ///< finished so far; empty pixels count in full
  std::atomic<double> noise = infinity; ///< latest estimate
  /// Estimate `noise` after each pass even if no limit needs it.
  bool isNoiseWanted = false;
  /// Time of the next pause: threads then finish their tiles and take no others.
  std::atomic<Clock::time_point> pauseAt = Clock::time_point::max();
  /// Called in each pause and between two passes with the result so far, from which render() can
  /// resume. The render waits.
  std::function<void(const RenderResult&)> onPause = {};
  /// Called at the end of each pass, before anything is decided by it. May add the tiles of other
  /// shards to the film, and change `end` to what all processes have agreed on.
  std::function<void(RenderResult&, PassEnd& end)> onPassEnd = {};
};

enum class StopReason { samples, seconds, noise, request };

/// The last pass that no limit of samples or time cut short. All later passes follow from it alone,
/// so a resumed render toward a noise target ends as an uninterrupted one does.
struct LastPass {
  std::uint64_t samples = 0; ///< mean per pixel at its end
  double noise = infinity;   ///< Film::noise() then, if the raw image has a noise target
  SamplePlan plan = {};
};

struct RenderResult {
  Film film;
  Counters counters = {};
  StopReason reason = StopReason::samples;
  /// Mean samples per pixel, over pixels with isDeterministic = false. After a stop on request some
  /// tiles may be one pass ahead.
  std::uint64_t finishedSamples = 0;
  std::uint64_t begunSamples = 0; ///< at the end of the pass started last
  LastPass last = {};
  /// Instruction set, "scalar", or GPU and driver: images of the same target are bit-identical.
  std::string target = "scalar";
  /// Why the GPU was given up during the render, which the CPU then repeated; else empty.
  std::string gpuFailure = {};
};

/// True if SIMD supports the scene (SimdTracker::isSupported, SimdShading::isSupported).
bool canUseSimd(const SceneView& scene);

/// A GPU of this machine: name and driver. Software devices are used for tests only.
struct GpuInfo {
  std::string name;
  bool isUsed;
};
std::vector<GpuInfo> listGpus();

/// Why the GPU cannot render a scene; none: it can, if the device has memory enough.
std::optional<std::string> findGpuObstacle(const SceneView& scene);

/// RenderResult::target that a render will have.
std::string findTarget(const SceneView& scene, const RenderSettings& settings);

/// `resumed`: earlier result to resume from, of the same scene and settings. Threads and the limits
/// of samples, time and noise may differ, with two conditions: at least resumed->begunSamples
/// samples, and past the pilot the same isAdaptive().
RenderResult render(const SceneView& scene, const RenderSettings& settings, RenderMonitor& monitor,
                    std::optional<RenderResult> resumed = {});

} // namespace fenestra::core
