#pragma once
// From a prepared scene to a film: passes over the picture up to a limit of samples, time or noise.
// The voxel type is resolved once, in withMedium; everything below is a template.

#include "image/Film.h"
#include "image/Tiles.h"
#include "integrator/render/SamplePlan.h"
#include "integrator/scalar/Counters.h"
#include "integrator/scalar/MajorantGrid.h"
#include "integrator/scalar/PathIntegrator.h"
#include "model/lights/LightSet.h"
#include "model/volume/Domain.h"
#include "model/volume/Volume.h"

#include <atomic>
#include <functional>
#include <string>

namespace fenestra {

/// Data that transport reads; all must outlive the render.
struct SceneView {
  const Volume& volume;
  const TransferFunction& transfer;
  const MajorantGrid& majorants;
  const LightSet& lights;
  const Camera& camera;
  const Clip& clip;
  std::optional<CropBox> crop = {};
  const ContextStyle* style = nullptr; ///< of the context; null: unchanged
  const Tint* tint = nullptr;          ///< of segments; null: none
  const Mixture* mixture = nullptr;    ///< of segments, in place of a tint; null: none
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

/// Implementation of transport. Both are unbiased; `fast` falls back to `readable` if lanes do not
/// serve.
enum class Integrator { simd, scalar };

/// Limits of a render, which stops at the first of samples, seconds and noise. With a noise target
/// on the raw picture, noisier pixels get more samples, after a pilot of 16 (SamplePlan); else all
/// get the same number.
struct RenderSettings {
  PathSettings path;
  std::uint64_t samples = 64; ///< limit of the mean number per pixel
  double seconds = infinity;  ///< limit of the time of transport
  double noise = -1.0; ///< limit of Film::noise() after a pass, from 16 samples on; negative: none
  /// Noise of the picture as it will be seen, in place of Film::noise(): looked at after 4, 8, 16,
  /// … samples, so that a lucky picture in between ends nothing. Empty: Film::noise().
  std::function<double(const Film&)> displayNoise = {};
  std::uint64_t seed = 0;
  Sampling sampling = Sampling::stratified;
  Integrator integrator = Integrator::simd;
  int threads = 0;               ///< 0: all
  std::uint64_t passSamples = 0; ///< in a pass; 0: growing passes. Never changes the picture.
  Shard shard = {}; ///< of the picture's tiles; the others stay empty. Not with `noise`.

  /// True if noisier pixels get more samples, once the pilot has ended.
  bool isAdaptive() const { return noise > 0.0 && !displayNoise; }
};

class Pass;
struct RenderMonitor;
struct RenderResult;

/// Other processes that take tiles of a pass, from another thread, and add them to the film.
struct RemoteWorkers {
  int count = 0;
  /// Lends them tiles of the pass, and lets them add to result.film, until the next settle().
  std::function<void(Pass&, RenderResult&)> dispatch = {};
  /// Called when this process's threads have no tile left, or rest. Returns once the pass is whole,
  /// or `monitor` wants a film kept or a stop; nothing is added any more then. The result: counts
  /// of what was added.
  std::function<Counters(const RenderMonitor&)> join = {};
};

/// Progress of a running render, and its stop flag.
struct RenderMonitor {
  std::atomic<bool> stop = false;
  std::atomic<std::uint64_t> paths = 0; ///< finished so far, as if no pixel were empty
  std::atomic<double> noise = infinity; ///< at the last look
  /// Somebody watches `noise`: it is estimated after each pass, though nothing else needs it.
  bool isNoiseWanted = false;
  /// Called between two passes with the result so far; the render waits.
  std::function<void(const RenderResult&)> onPassEnd = {};
  /// Looked at by all threads, often. Once true, they end their tiles, and `keep` is called with
  /// the result so far, which render() goes on from; the render waits. Empty: never.
  std::function<bool()> isCheckpointDue = {};
  std::function<void(const RenderResult&)> onCheckpoint = {};
  RemoteWorkers workers = {};
};

enum class StopReason { samples, seconds, noise, request };

/// Last pass that no limit of samples or time has cut short. The passes after it follow from it
/// alone, so that a render toward a noise target that goes on ends as if it had not been stopped.
struct LastPass {
  std::uint64_t samples = 0; ///< mean per pixel at its end
  double noise = infinity;   ///< Film::noise() there, for a target on the raw picture
  SamplePlan plan = {};
};

struct RenderResult {
  Film film;
  Counters counters = {};
  StopReason reason = StopReason::samples;
  /// Mean samples per pixel, over pixels with isCertain = false. After a stop by request single
  /// tiles may be one pass ahead.
  std::uint64_t finishedSamples = 0;
  std::uint64_t begunSamples = 0; ///< at the end of the pass that was begun last
  LastPass last = {};
  /// Arithmetic within which pictures are bit-identical: "scalar", or the lanes' instruction set.
  std::string target = "scalar";
};

/// True if SIMD lanes serve the scene (SimdTracker::serves, SimdShading::serves).
bool canUseSimd(const SceneView& scene);

/// RenderResult::target of a render.
std::string findTarget(const SceneView& scene, const RenderSettings& settings);

/// `begun`: result of a render of the same scene and settings to go on from, but for threads and
/// the limits of samples, time and noise: at least begun->begunSamples samples, and planned by
/// noise or not as before if that is beyond the pilot.
RenderResult render(const SceneView& scene, const RenderSettings& settings, RenderMonitor& monitor,
                    std::optional<RenderResult> resumed = {});

/// Tiles that another process lends, and the stages of the plan between which their pixels lack
/// samples (SamplePlan::at).
struct TileLease {
  std::vector<int> tiles;
  std::uint64_t from = 0, to = 0;
};

/// Renders tiles for the process whose render has this one among its helpers. `next` takes the last
/// loan's tiles from result.film, with result.counters, unless the stop flag is set; it puts the
/// next one's pixels there, and the plan into result.last. It returns the next loan, or nothing at
/// the end.
void renderLeases(const SceneView& scene, const RenderSettings& settings, RenderMonitor& monitor,
                  const std::function<std::optional<TileLease>(RenderResult&)>& next);

} // namespace fenestra
