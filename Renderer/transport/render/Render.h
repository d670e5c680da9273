#pragma once
// From a prepared scene to a film: passes over the picture until enough samples, time or quality.
// The voxel type is resolved once, here; below it everything is a template.

#include "image/Film.h"
#include "model/lights/LightSet.h"
#include "model/volume/Domain.h"
#include "model/volume/Volume.h"
#include "transport/readable/Counters.h"
#include "transport/readable/MajorantGrid.h"
#include "transport/readable/PathEstimator.h"

#include <atomic>
#include <functional>
#include <string>

namespace fenestra {

/// Everything that transport reads; all of it outlives the render.
struct RenderScene {
  const Volume& volume;
  const TransferFunction& transfer;
  const MajorantGrid& majorants;
  const LightSet& lights;
  const Camera& camera;
  const Clip& clip;
  std::optional<CropBox> crop = {};
  const ContextStyle* style = nullptr; ///< of what is not focus; null where it looks as it is
};

/// How paths find their way. Both are unbiased; `fast` is `readable` where its lanes do not serve
/// (WideTracker::serves, EventScene::serves).
enum class Transport { fast, readable };

/// Stops at the first of samples, seconds and noise. Toward a noise target, pixels that are noisier
/// get more samples than others, after a pilot of 16 (SamplePlan); else all get the same number.
struct RenderSettings {
  PathSettings path;
  std::uint64_t samples = 64; ///< a pixel, at most; on average
  double seconds = infinity;  ///< of transport
  double noise = -1.0; ///< Film::noise() at the end of a pass, from 16 samples on; negative: never
  std::uint64_t seed = 0;
  Transport transport = Transport::fast;
  int threads = 0;               ///< 0: all
  std::uint64_t passSamples = 0; ///< samples a pass; 0: growing passes. Never changes the picture.
};

struct RenderResult;

/// Progress of a running render, and the way to stop it.
struct RenderMonitor {
  std::atomic<bool> stop = false;
  std::atomic<std::uint64_t> paths = 0; ///< finished so far, or found to be needless
  std::atomic<double> noise = infinity; ///< at the end of the last pass
  /// Called between two passes with what there is by then; the render waits.
  std::function<void(const RenderResult&)> between = {};
};

enum class StopReason { samples, seconds, noise, request };

struct RenderResult {
  Film film;
  Counters counters;
  StopReason reason = StopReason::samples;
  /// A pixel, on average over those that are not certain from one (PixelSums::isCertain); after a
  /// request some may have more.
  std::uint64_t finishedSamples = 0;
  /// Pictures are bit-identical within one target: "scalar", or the lanes' instruction set.
  std::string target = "scalar";
};

RenderResult render(const RenderScene& scene, const RenderSettings& settings,
                    RenderMonitor& monitor);

} // namespace fenestra
