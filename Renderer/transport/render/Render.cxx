#include "transport/render/Render.h"

#include "base/Stopwatch.h"
#include "transport/readable/PathEstimator.h"
#include "transport/render/EmptyPixels.h"
#include "transport/render/SamplePlan.h"
#include "transport/render/TileStream.h"

#include <tbb/combinable.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <bit>
#include <numeric>

namespace fenestra {
namespace {

/// Samples per pixel below which a noise estimate is too uncertain to stop by.
constexpr std::uint64_t leastForNoise = 16;

/// Traces one path after the other.
template <typename Voxel>
struct OneByOne {
  PathEstimator<Voxel> estimator;

  template <typename Source>
  bool trace(Source& source, std::size_t atOnce, Counters& counters) const {
    const auto starts = std::make_unique<PathStarts>();
    do {
      source.fill(*starts, std::min(atOnce, RayBatch::capacity));
      for (std::size_t i = 0; i < starts->size; ++i) {
        const SampleNumbers numbers =
            source.numbers().numbers({starts->start[i], starts->key[i]}, starts->number[i]);
        const Vec2 place = uniform2Of(numbers.position) + Vec2(starts->column[i], starts->row[i]);
        const std::optional<PathSample> sample =
            estimator.trace(place.x(), place.y(), numbers, counters);
        if (!sample)
          return false;
        source.deliver(starts->tile[i], starts->ofTile[i], *sample);
      }
    } while (starts->size > 0);
    return true;
  }
};

/// Samples per pixel of the next pass. Passes grow, so that a picture is there early and overhead
/// stays small later; sizes are fixed, so that a stop by noise falls on the same sample count on
/// every machine.
std::uint64_t passSize(std::uint64_t done, const RenderSettings& settings) {
  constexpr std::uint64_t largest = 16;
  const std::uint64_t grown = std::clamp<std::uint64_t>(done, 1, largest);
  const std::uint64_t wanted = settings.passSamples > 0 ? settings.passSamples : grown;
  return std::min(wanted, settings.samples - done);
}

/// Samples per pixel of the next pass toward a noise target. The pilot ends at leastForNoise
/// whatever the passes are. After the pilot passes grow from 1 again, for some pixels may get far
/// more than the mean; the last pass is as small as the noise so far predicts (variance ~ 1 /
/// samples).
std::uint64_t passTowardNoise(std::uint64_t done, double noise, const SamplePlan& plan,
                              const RenderSettings& settings) {
  if (done < leastForNoise)
    return std::min(passSize(done, settings), leastForNoise - done);
  constexpr double mostInOnePixel = 256.0;
  const double missing = static_cast<double>(done) * (std::pow(noise / settings.noise, 2.0) - 1.0);
  const double room = mostInOnePixel / plan.at(done + 1).greatestShare();
  const auto most = static_cast<std::uint64_t>(std::max(1.0, std::min(missing, room)));
  return std::min({passSize(done - leastForNoise, settings), settings.samples - done, most});
}

/// Renders the samples of stage `to` beyond stage `from`. Returns false if stopped before all were
/// done; tiles are done whole or not at all.
template <typename Tracer>
bool renderPass(const Tracer& tracer, const SamplePlan::Stage& from, const SamplePlan::Stage& to,
                const EmptyPixels& empty, const NumberSource& source, Film& film, Counters& total,
                RenderMonitor& monitor) {
  Pass pass(from, to, empty, source, film, monitor.paths);
  const int threads = tbb::this_task_arena::max_concurrency();
  // Paths at once in a thread: limited, so that all threads get some and tails are short.
  const std::size_t atOnce =
      std::max<std::size_t>(64, film.pixelCount() / (4 * static_cast<std::size_t>(threads)));
  tbb::combinable<Counters> counters;
  tbb::parallel_for(
      0, threads,
      [&](int) {
        TileStream stream(pass);
        if (!monitor.stop.load(std::memory_order_relaxed))
          tracer.trace(stream, atOnce, counters.local());
      },
      tbb::simple_partitioner());
  counters.combine_each([&](const Counters& local) { total += local; });
  return pass.whole();
}

/// True if all eye rays through one pixel that meet no matter return the same radiance.
bool isConstantInPixels(const Background& background, const LightSet& lights) {
  return background.kind != Background::Kind::environment ||
         (!lights.hasMaps() && lights.skies().empty());
}

/// Duration of passes, and the samples that the time limit still allows.
class Pace {
public:
  explicit Pace(double secondsInAll) : m_secondsInAll(secondsInAll) {}

  void passed(std::uint64_t samples) {
    const double now = m_watch.seconds();
    m_perSample = (now - m_last) / static_cast<double>(samples);
    m_last = now;
  }
  /// Time until now went into a look, not into samples.
  void looked() { m_last = m_watch.seconds(); }
  /// Number of samples that the remaining time allows, at the last pass's time per sample.
  std::uint64_t affordable() const {
    if (!(m_secondsInAll < infinity) || m_perSample == 0.0)
      return std::numeric_limits<std::uint64_t>::max();
    const double left = m_secondsInAll - m_watch.seconds();
    return static_cast<std::uint64_t>(std::clamp(left / m_perSample, 0.0, 1e9));
  }

private:
  double m_secondsInAll;
  Stopwatch m_watch;
  double m_last = 0.0, m_perSample = 0.0;
};

/// Number of samples at which the seen noise is looked at next.
std::uint64_t nextLook(std::uint64_t done) {
  constexpr std::uint64_t first = 4;
  return std::max(first, std::bit_ceil(done + 1));
}

/// Decides how many samples a pass gets, and when the noise is low enough.
class NoiseLimit {
public:
  explicit NoiseLimit(const RenderSettings& settings) : m_settings(settings) {}

  std::uint64_t nextPass(std::uint64_t done, double noise) const {
    if (isRaw())
      return passTowardNoise(done, noise, m_plan, m_settings);
    const std::uint64_t size = passSize(done, m_settings);
    return isSeen() ? std::min(size, nextLook(done) - done) : size;
  }
  SamplePlan::Stage stage(std::uint64_t mean) const { return m_plan.at(mean); }

  /// Looks at the film after a pass, if a look is due, and sets `noise`. Returns true if the target
  /// is reached.
  bool isReached(const Film& film, std::uint64_t done, std::atomic<double>& noise) {
    if (isSeen()) {
      if (nextLook(done - 1) != done)
        return false;
      noise = m_settings.seenNoise(film);
      return noise <= m_settings.noise;
    }
    noise = film.noise();
    if (!isRaw() || done < leastForNoise)
      return false;
    if (done == leastForNoise)
      m_plan = SamplePlan(film);
    return noise <= m_settings.noise;
  }

private:
  bool isSeen() const { return m_settings.noise > 0.0 && m_settings.seenNoise; }
  bool isRaw() const { return m_settings.noise > 0.0 && !m_settings.seenNoise; }

  const RenderSettings& m_settings;
  SamplePlan m_plan;
};

template <typename Tracer>
RenderResult renderPasses(const Tracer& tracer, const std::string& arithmetic,
                          const RenderScene& scene, const RenderSettings& settings,
                          RenderMonitor& monitor) {
  const NumberSource source(settings.sampling, settings.seed);
  RenderResult result{Film(scene.camera.width(), scene.camera.height(),
                           NumberSource::hasIndependentHalves, source.block()),
                      {},
                      {},
                      0,
                      arithmetic};
  const EmptyPixels empty = isConstantInPixels(settings.path.background, scene.lights)
                                ? EmptyPixels(scene.camera, scene.majorants)
                                : EmptyPixels();
  for (int row = 0; row < result.film.height(); ++row)
    for (int column = 0; column < result.film.width(); ++column)
      result.film.at(column, row).isCertain = empty.contains(column, row);
  NoiseLimit target(settings);
  Pace pace(settings.seconds);
  while (result.finishedSamples < settings.samples) {
    const std::uint64_t done = result.finishedSamples;
    const std::uint64_t count = std::min(target.nextPass(done, monitor.noise), pace.affordable());
    if (count == 0) {
      result.reason = StopReason::seconds;
      return result;
    }
    if (done > 0 && monitor.between)
      monitor.between(result);
    if (!renderPass(tracer, target.stage(done), target.stage(done + count), empty, source,
                    result.film, result.counters, monitor)) {
      result.reason = StopReason::request;
      return result;
    }
    pace.passed(count);
    result.finishedSamples += count;
    if (target.isReached(result.film, result.finishedSamples, monitor.noise)) {
      result.reason = StopReason::noise;
      return result;
    }
    pace.looked();
  }
  return result;
}

RenderResult renderInLanes(const RenderScene& scene, const RenderSettings& settings,
                           RenderMonitor& monitor) {
  const Domain domain(scene.volume.grid, scene.crop);
  const WideTracker tracker(scene.volume, domain, scene.transfer, scene.majorants, scene.clip,
                            scene.style, monitor.stop, scene.mixture);
  const WideEvents events(tracker.scene(),
                          EventScene(scene.volume.grid, scene.transfer, scene.lights,
                                     settings.path.bounces, settings.path.wantNormals, scene.tint,
                                     scene.mixture));
  const EyeRays eye(scene.camera, eyeClip(scene.clip, scene.mixture), scene.lights,
                    settings.path.background);
  const WideEyeRays begin(tracker.scene(), domain, scene.camera, eye);
  const PathWave wave(begin, tracker, events, eye, monitor.stop);
  return renderPasses(wave, WideTracker::instructionSet(), scene, settings, monitor);
}

RenderResult renderOneByOne(const RenderScene& scene, const RenderSettings& settings,
                            RenderMonitor& monitor) {
  const auto work = [&]<typename Voxel>(const Medium<Voxel>& medium,
                                        const Tracker<Voxel>& tracker) {
    const OneByOne<Voxel> readable{PathEstimator<Voxel>(scene.volume.grid, medium, tracker,
                                                        scene.lights, scene.camera, scene.clip,
                                                        settings.path, monitor.stop)};
    return renderPasses(readable, "scalar", scene, settings, monitor);
  };
  return withMedium(scene, work, monitor.stop);
}

} // namespace

bool lanesServe(const RenderScene& scene) {
  return WideTracker::serves(scene.volume, scene.transfer, scene.mixture) &&
         EventScene::serves(scene.volume.grid, scene.transfer, scene.lights, scene.mixture) &&
         (!scene.tint || WideShares::serves(*scene.tint->shares));
}

RenderResult render(const RenderScene& scene, const RenderSettings& settings,
                    RenderMonitor& monitor) {
  const int cores = tbb::info::default_concurrency(); // TBB complains about more
  tbb::task_arena arena(settings.threads > 0 ? std::min(settings.threads, cores) : cores);
  return arena.execute([&] {
    return settings.transport == Transport::fast && lanesServe(scene)
               ? renderInLanes(scene, settings, monitor)
               : renderOneByOne(scene, settings, monitor);
  });
}

} // namespace fenestra
