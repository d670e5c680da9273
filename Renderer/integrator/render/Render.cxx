#include "integrator/render/Render.h"

#include "base/Stopwatch.h"
#include "integrator/render/EmptyPixels.h"
#include "integrator/render/SamplePlan.h"
#include "integrator/render/Tracing.h"

#include <tbb/combinable.h>
#include <tbb/parallel_for.h>

#include <bit>
#include <numeric>

namespace fenestra::core {
namespace {

/// Samples per pixel below which a noise estimate is too uncertain to stop the render.
constexpr std::uint64_t minNoiseSamples = SamplePlan::pilotSamples;

/// Growth of passes, in samples per pixel.
struct PassGrowth {
  std::uint64_t perSample = 1; ///< samples of a pass per sample before it
  std::uint64_t largest = 16;
};

/// Samples per pixel of the next pass. Passes grow, so that the first image appears early and later
/// overhead is small. Sizes are fixed, so that a noise limit stops at the same sample count on
/// every machine.
std::uint64_t choosePassSize(std::uint64_t done, const RenderSettings& settings,
                             const PassGrowth& growth = {}) {
  const std::uint64_t grown = std::clamp<std::uint64_t>(done * growth.perSample, 1, growth.largest);
  return settings.passSamples > 0 ? settings.passSamples : grown;
}

/// Samples per pixel of the next pass toward a noise target. The pilot always ends at
/// minNoiseSamples. After it passes grow from 1 again, since some pixels may get far more than the
/// mean. The last pass is only as large as the noise predicts (variance ~ 1 / samples).
std::uint64_t chooseNoisePassSize(const LastPass& last, const RenderSettings& settings) {
  const std::uint64_t done = last.samples;
  if (done < minNoiseSamples)
    return std::min(choosePassSize(done, settings), minNoiseSamples - done);
  constexpr double maxPerPixel = 256.0; // samples of one pixel in a pass
  const double missing =
      static_cast<double>(done) * (std::pow(last.noise / settings.noise, 2.0) - 1.0);
  const double limit = maxPerPixel / last.plan.at(done + 1).maxRatio();
  const auto most = static_cast<std::uint64_t>(std::max(1.0, std::min(missing, limit)));
  return std::min(choosePassSize(done - minNoiseSamples, settings), most);
}

/// Renders the rest of a pass, until its end, a pause or a stop. Tiles are added complete or not at
/// all.
template <typename Tracer>
void renderTiles(const Tracer& tracer, Pass& pass, const Film& film, Counters& total,
                 RenderMonitor& monitor) {
  const Streams streams = planStreams(tracer, film);
  tbb::combinable<Counters> counters;
  tbb::parallel_for(
      0, streams.count,
      [&](int i) {
        TileStream stream(pass, monitor.pauseAt);
        if (!monitor.stop.load(std::memory_order_relaxed))
          traceStream(tracer, i, stream, streams.maxPaths, counters.local());
      },
      tbb::simple_partitioner());
  counters.combine_each([&](const Counters& local) { total += local; });
}

/// Inputs that all passes of a render share.
struct PassInputs {
  std::vector<int> tiles;
  EmptyPixels empty;
  Sampler sampler;
};

/// Renders the samples that the film lacks up to stage `result.begunSamples`. Returns false if
/// stopped before all were finished.
template <typename Tracer>
bool renderPass(const Tracer& tracer, const PassInputs& inputs, RenderResult& result,
                RenderMonitor& monitor) {
  const SamplePlan& plan = result.last.plan;
  Pass pass(inputs.tiles, plan.at(result.finishedSamples), plan.at(result.begunSamples),
            inputs.empty, inputs.sampler, result.film, monitor.paths);
  for (;;) {
    renderTiles(tracer, pass, result.film, result.counters, monitor);
    if (pass.isComplete() || monitor.stop)
      return pass.isComplete();
    if (monitor.onPause)
      monitor.onPause(result);
  }
}

/// Finds the pixels that need only one sample, and marks them as deterministic in the film.
EmptyPixels markEmptyPixels(const SceneView& scene, const RenderSettings& settings, Film& film) {
  EmptyPixels empty = findEmptyPixels(scene, settings);
  for (int row = 0; row < film.height(); ++row)
    for (int column = 0; column < film.width(); ++column)
      film.at(column, row).isDeterministic = empty.contains(column, row);
  return empty;
}

/// Measures passes, and predicts the samples that fit into the time limits.
class TimeBudget {
public:
  explicit TimeBudget(const RenderSettings& settings)
      : m_limit(settings.seconds), m_passLimit(settings.passSeconds) {}

  void addPass(std::uint64_t samples) {
    const double now = m_watch.seconds();
    m_perSample = (now - m_last) / static_cast<double>(samples);
    m_last = now;
  }
  /// Excludes the time since the last pass, which was spent at its end.
  void restartClock() { m_last = m_watch.seconds(); }
  /// Samples per pixel that fit into the remaining time and into a pass, at the speed of the last
  /// pass; 1 before the first.
  std::uint64_t maxNextSamples() const {
    if (!(std::min(m_limit, m_passLimit) < infinity))
      return std::numeric_limits<std::uint64_t>::max();
    if (m_perSample == 0.0)
      return 1;
    const auto fit = [&](double seconds, double least) {
      return static_cast<std::uint64_t>(std::clamp(seconds / m_perSample, least, 1e9));
    };
    return std::min(fit(m_limit - m_watch.seconds(), 0.0), fit(m_passLimit, 1.0));
  }

private:
  double m_limit, m_passLimit;
  Stopwatch m_watch;
  double m_last = 0.0, m_perSample = 0.0;
};

/// Number of samples at which the display image's noise is estimated next.
std::uint64_t nextNoiseCheck(std::uint64_t done) {
  constexpr std::uint64_t first = 4;
  return std::max(first, std::bit_ceil(done + 1));
}

/// Decides how many samples a pass gets, and whether the noise is low enough.
class NoiseLimit {
public:
  NoiseLimit(const RenderSettings& settings, const PassGrowth& growth)
      : m_settings(settings), m_growth(growth) {}

  /// Samples per pixel of the pass after `last`, if no other limit cuts it short.
  std::uint64_t nextPass(const LastPass& last) const {
    if (m_settings.isAdaptive())
      return chooseNoisePassSize(last, m_settings);
    const std::uint64_t size = choosePassSize(last.samples, m_settings, m_growth);
    if (hasDisplayNoise())
      return std::min(size, nextNoiseCheck(last.samples) - last.samples);
    const std::uint64_t left = m_settings.samples - last.samples;
    return left <= size + size / 2 ? left : size; // avoids a short last pass
  }

  /// True if PassEnd::displayNoise is needed at this number of samples.
  bool needsDisplayNoise(std::uint64_t done) const {
    return hasDisplayNoise() && nextNoiseCheck(done - 1) == done;
  }

  /// Stores the noise after a pass in `monitor.noise`. Returns true if the target is reached. If
  /// the pass was not cut short, it becomes result.last.
  bool check(RenderResult& result, const PassEnd& end, bool isShortened,
             RenderMonitor& monitor) const {
    const std::uint64_t done = result.finishedSamples;
    std::atomic<double>& noise = monitor.noise;
    if (!isShortened)
      result.last.samples = done;
    if (hasDisplayNoise()) {
      if (!end.isNoiseDue)
        return false;
      noise = end.displayNoise;
      return noise <= m_settings.noise;
    }
    const bool isPlanned = m_settings.isAdaptive();
    if (isPlanned || monitor.isNoiseWanted)
      noise = result.film.noise();
    if (!isPlanned || isShortened)
      return false;
    result.last.noise = noise;
    if (done < minNoiseSamples)
      return false;
    if (done == minNoiseSamples)
      result.last.plan = SamplePlan(result.film);
    return noise <= m_settings.noise;
  }

private:
  bool hasDisplayNoise() const { return m_settings.noise > 0.0 && m_settings.isDisplayNoise; }

  const RenderSettings& m_settings;
  const PassGrowth m_growth;
};

/// Short passes cost more per sample: each pass reloads the volume into the caches and ends with
/// idle threads. So passes of a shard, which has fewer tiles, grow faster and larger.
PassGrowth choosePassGrowth(const RenderSettings& settings) {
  const auto shards = static_cast<std::uint64_t>(settings.shard.count);
  return {settings.passGrowth * shards, 16 * shards};
}

/// Result before the first sample.
RenderResult makeEmptyResult(const Camera& camera, const Sampler& sampler) {
  return {Film(camera.width(), camera.height(), Sampler::hasIndependentHalfBuffers,
               sampler.samplesPerBlock())};
}

/// True if every pixel of the film is exactly at the end of result.last.
bool isAtLastPass(const RenderResult& result) {
  const SamplePlan::Stage stage = result.last.plan.at(result.last.samples);
  const std::vector<PixelSums>& pixels = result.film.pixels();
  for (std::size_t i = 0; i < pixels.size(); ++i)
    if (!pixels[i].isDeterministic && pixels[i].samples != stage.count(i))
      return false;
  return result.last.samples > 0 && result.finishedSamples == result.last.samples;
}

template <typename Tracer>
RenderResult renderPasses(const Tracer& tracer, const std::string& target, const SceneView& scene,
                          const RenderSettings& settings, RenderMonitor& monitor,
                          std::optional<RenderResult> resumed) {
  const Sampler sampler(settings.sampling, settings.seed);
  RenderResult result = resumed ? std::move(*resumed) : makeEmptyResult(scene.camera, sampler);
  result.reason = StopReason::samples;
  result.target = target;
  if (!settings.isAdaptive())
    result.last = {result.last.samples}; // ignores an adaptive plan of an earlier run
  const PassInputs inputs{Tiles(result.film.width(), result.film.height()).select(settings.shard),
                          markEmptyPixels(scene, settings, result.film), sampler};
  monitor.paths = result.finishedSamples * result.film.pixelCount() /
                  static_cast<std::size_t>(settings.shard.count);
  const NoiseLimit noiseLimit(settings, choosePassGrowth(settings));
  TimeBudget budget(settings);
  std::uint64_t maxNextSamples = budget.maxNextSamples();
  // Returns true if the render ends with this pass.
  const auto endPass = [&](std::uint64_t done, bool isComplete, bool isShortened) {
    PassEnd end{isComplete, budget.maxNextSamples(),
                isComplete && noiseLimit.needsDisplayNoise(done), infinity};
    if (monitor.onPassEnd)
      monitor.onPassEnd(result, end);
    maxNextSamples = end.maxNextSamples;
    if (end.isComplete)
      result.finishedSamples = done;
    if (!end.isComplete)
      result.reason = StopReason::request;
    else if (noiseLimit.check(result, end, isShortened, monitor))
      result.reason = StopReason::noise;
    budget.restartClock();
    return result.reason != StopReason::samples;
  };
  if (isAtLastPass(result) && endPass(result.finishedSamples, true, false))
    return result;
  while (result.finishedSamples < settings.samples) {
    const std::uint64_t done = result.finishedSamples;
    const std::uint64_t passEnd =
        std::max(result.last.samples + noiseLimit.nextPass(result.last), done + 1);
    const std::uint64_t count = std::min({passEnd - done, settings.samples - done, maxNextSamples});
    if (count == 0) {
      result.reason = StopReason::seconds;
      return result;
    }
    if (done > 0 && monitor.onPause)
      monitor.onPause(result);
    result.begunSamples = done + count;
    const bool isComplete = renderPass(tracer, inputs, result, monitor);
    budget.addPass(count);
    if (endPass(done + count, isComplete, done + count < passEnd))
      return result;
  }
  return result;
}

} // namespace

bool canUseSimd(const SceneView& scene) {
  return SimdTracker::isSupported(scene.volume, scene.transfer, scene.mixture) &&
         SimdShading::isSupported(scene.volume.grid, scene.transfer, scene.lights, scene.mixture) &&
         (!scene.tint || SimdLabelWeights::isSupported(*scene.tint->weights));
}

std::vector<GpuInfo> listGpus() {
  std::vector<GpuInfo> gpus;
  for (const gpu::DeviceInfo& device : gpu::Device::list())
    gpus.push_back({device.target(), device.isUsed});
  return gpus;
}

std::optional<std::string> findGpuObstacle(const SceneView& scene) {
  if (!canUseSimd(scene))
    return "the scene needs double precision";
  try {
    gpu::Device::open();
  } catch (const gpu::DeviceError& error) {
    return error.what();
  }
  return std::nullopt;
}

std::string findTarget(const SceneView& scene, const RenderSettings& settings) {
  if (settings.integrator == Integrator::gpu && !findGpuObstacle(scene))
    return gpu::Device::open()->info().target();
  return isSimdUsed(scene, settings) ? instructionSet() : "scalar";
}

RenderResult render(const SceneView& scene, const RenderSettings& settings, RenderMonitor& monitor,
                    std::optional<RenderResult> resumed) {
  std::string failure;
  if (settings.integrator == Integrator::gpu && !findGpuObstacle(scene))
    try {
      return inArena(settings, [&] {
        return traceGpu(scene, settings, monitor.stop,
                        [&](const auto& tracer, const std::string& target) {
                          return renderPasses(tracer, target, scene, settings, monitor, resumed);
                        });
      });
    } catch (const gpu::DeviceError& error) {
      failure = error.what();
      gpu::Device::forget();
    }
  RenderResult result =
      traceScene(scene, settings, monitor.stop, [&](const auto& tracer, const std::string& target) {
        return renderPasses(tracer, target, scene, settings, monitor, std::move(resumed));
      });
  result.gpuFailure = failure;
  return result;
}

} // namespace fenestra::core
