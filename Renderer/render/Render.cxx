#include "render/Render.h"

#include "core/Stopwatch.h"
#include "render/SamplePlan.h"
#include "transport/PathEstimator.h"
#include "transport/PathWave.h"

#include <tbb/blocked_range2d.h>
#include <tbb/combinable.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <numeric>

namespace fenestra {
namespace {

/// A noise estimate from fewer samples a pixel is too uncertain to stop by.
constexpr std::uint64_t leastForNoise = 16;

/// Dispatches once on the volume's storage type.
template <typename Work>
auto withMedium(const RenderScene& scene, Work&& work) {
  return std::visit(
      [&](const auto& voxels) {
        using Voxel = typename std::decay_t<decltype(voxels)>::value_type;
        const Medium<Voxel> medium(scene.volume.grid, voxels, scene.transfer);
        const Tracker<Voxel> tracker(Domain(scene.volume.grid, scene.crop), medium, scene.majorants,
                                     scene.clip);
        return work(medium, tracker);
      },
      scene.volume.voxels);
}

/// One path after the other.
template <typename Voxel>
struct OneByOne {
  PathEstimator<Voxel> estimator;

  template <typename Start, typename Deliver>
  bool trace(std::size_t count, Start&& start, Deliver&& deliver, Counters& counters) const {
    for (std::size_t i = 0; i < count; ++i) {
      PathStart from = start(i);
      const std::optional<PathSample> sample =
          estimator.trace(from.column, from.row, from.random, counters);
      if (!sample || estimator.stopped())
        return false;
      deliver(i, *sample);
    }
    return true;
  }
};

/// Passes grow, so that a picture is there early and overhead stays small later; their sizes are
/// fixed, so that a stop by noise falls on the same sample count on every machine. The last before
/// a noise target is as small as the noise so far says, variance falling as one over the samples.
std::uint64_t passSize(std::uint64_t done, double noise, const RenderSettings& settings) {
  constexpr std::uint64_t largest = 16;
  std::uint64_t size =
      settings.passSamples > 0 ? settings.passSamples : std::clamp<std::uint64_t>(done, 1, largest);
  if (settings.noise > 0.0 && done < leastForNoise)
    size = std::min(size, leastForNoise - done); // the pilot is the same for all pass sizes
  if (settings.noise > 0.0 && done >= leastForNoise) {
    const double missing =
        static_cast<double>(done) * (std::pow(noise / settings.noise, 2.0) - 1.0);
    size = std::min(size, static_cast<std::uint64_t>(std::max(1.0, std::min(missing, 1e6))));
  }
  return std::min(size, settings.samples - done);
}

/// The samples of a tile's pixels that one stage of the plan has and the one before has not,
/// counted pixel by pixel.
class TileSamples {
public:
  TileSamples(const tbb::blocked_range2d<int>& tile, const SamplePlan::Stage& from,
              const SamplePlan::Stage& to, int width)
      : m_width(width) {
    for (int row = tile.rows().begin(); row < tile.rows().end(); ++row)
      for (int column = tile.cols().begin(); column < tile.cols().end(); ++column) {
        const std::size_t pixel = this->pixel(column, row);
        for (std::uint64_t sample = from.count(pixel); sample < to.count(pixel); ++sample)
          m_samples.push_back({column, row, sample});
      }
  }

  std::size_t size() const { return m_samples.size(); }
  PathStart start(std::size_t i, std::uint64_t seed) const {
    const Sample& sample = m_samples[i];
    Random random(seed, pixel(sample.column, sample.row), sample.number);
    const Vec2 jitter = random.uniform2();
    return {sample.column + jitter.x(), sample.row + jitter.y(), random};
  }
  /// To whose pixel sample i belongs.
  PixelSums& sums(std::size_t i, Film& film) const {
    return film.at(m_samples[i].column, m_samples[i].row);
  }

private:
  struct Sample {
    int column, row;
    std::uint64_t number;
  };

  std::size_t pixel(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(m_width) +
           static_cast<std::size_t>(column);
  }

  int m_width;
  std::vector<Sample> m_samples;
};

/// What one stage of the plan has beyond the one before. Returns false when it was stopped before
/// all was done; tiles are done whole or not at all.
template <typename Tracer>
bool renderPass(const Tracer& tracer, const SamplePlan::Stage& from, const SamplePlan::Stage& to,
                std::uint64_t seed, Film& film, Counters& total, RenderMonitor& monitor) {
  tbb::combinable<Counters> counters;
  tbb::combinable<std::vector<PathSample>> buffers;
  std::atomic<bool> whole = true;
  const auto renderTile = [&](const tbb::blocked_range2d<int>& tile) {
    const TileSamples tileSamples(tile, from, to, film.width());
    std::vector<PathSample>& samples = buffers.local();
    samples.resize(tileSamples.size());
    const auto start = [&](std::size_t i) { return tileSamples.start(i, seed); };
    const auto deliver = [&](std::size_t i, const PathSample& sample) { samples[i] = sample; };
    if (monitor.stop.load(std::memory_order_relaxed) ||
        !tracer.trace(samples.size(), start, deliver, counters.local())) {
      whole = false;
      return;
    }
    // In their own order, whichever ended first.
    for (std::size_t i = 0; i < samples.size(); ++i)
      tileSamples.sums(i, film).add(samples[i]);
    monitor.paths.fetch_add(samples.size(), std::memory_order_relaxed);
  };
  constexpr int tileSize = 16;
  tbb::parallel_for(
      tbb::blocked_range2d<int>(0, film.height(), tileSize, 0, film.width(), tileSize), renderTile);
  counters.combine_each([&](const Counters& local) { total += local; });
  return whole;
}

/// How many samples the time that is left allows, by the time that those so far took.
std::uint64_t affordable(double seconds, std::uint64_t done, const RenderSettings& settings) {
  if (!(settings.seconds < infinity) || done == 0)
    return std::numeric_limits<std::uint64_t>::max();
  const double perSample = seconds / static_cast<double>(done);
  return static_cast<std::uint64_t>(std::clamp((settings.seconds - seconds) / perSample, 0.0, 1e9));
}

template <typename Tracer>
RenderResult renderPasses(const Tracer& tracer, const RenderScene& scene,
                          const RenderSettings& settings, RenderMonitor& monitor) {
  RenderResult result{Film(scene.camera.width(), scene.camera.height()), {}, {}, 0};
  const Stopwatch watch;
  SamplePlan plan;
  while (result.finishedSamples < settings.samples) {
    const std::uint64_t done = result.finishedSamples;
    const std::uint64_t count = std::min(passSize(done, monitor.noise, settings),
                                         affordable(watch.seconds(), done, settings));
    if (count == 0) {
      result.reason = StopReason::seconds;
      return result;
    }
    if (!renderPass(tracer, plan.at(done), plan.at(done + count), settings.seed, result.film,
                    result.counters, monitor)) {
      result.reason = StopReason::request;
      return result;
    }
    result.finishedSamples += count;
    monitor.noise = result.film.noise();
    if (result.finishedSamples < leastForNoise)
      continue;
    if (monitor.noise <= settings.noise) {
      result.reason = StopReason::noise;
      return result;
    }
    if (settings.noise > 0.0 && done < leastForNoise)
      plan = SamplePlan(result.film);
  }
  return result;
}

} // namespace

RenderResult render(const RenderScene& scene, const RenderSettings& settings,
                    RenderMonitor& monitor) {
  const int cores = tbb::info::default_concurrency(); // TBB complains about more
  tbb::task_arena arena(settings.threads > 0 ? std::min(settings.threads, cores) : cores);
  return arena.execute([&] {
    return withMedium(scene, [&]<typename Voxel>(const Medium<Voxel>& medium,
                                                 const Tracker<Voxel>& tracker) {
      if (settings.transport == Transport::fast &&
          WideTracker::serves(scene.volume, scene.transfer) && WideEvents::serves(scene.transfer)) {
        const Domain domain(scene.volume.grid, scene.crop);
        const WideTracker wide(scene.volume, domain, scene.transfer, scene.majorants, scene.clip);
        const WideEvents events(wide.scene(),
                                EventScene(scene.volume.grid, scene.transfer, scene.lights,
                                           settings.path.bounces, settings.path.wantNormals));
        const EyeRays eye(scene.camera, scene.clip, scene.lights, settings.path.background);
        const PathWave wave(domain, wide, events, eye, monitor.stop);
        RenderResult result = renderPasses(wave, scene, settings, monitor);
        result.target = WideTracker::instructionSet();
        return result;
      }
      const OneByOne<Voxel> readable{PathEstimator<Voxel>(scene.volume.grid, medium, tracker,
                                                          scene.lights, scene.camera, scene.clip,
                                                          settings.path, monitor.stop)};
      return renderPasses(readable, scene, settings, monitor);
    });
  });
}

double focusCoverage(const RenderScene& scene, const std::vector<double>& focusDepth,
                     std::uint64_t seed) {
  const int width = scene.camera.width();
  return withMedium(scene, [&](const auto&, const auto& tracker) {
    std::vector<double> shown(focusDepth.size(), 0.0);
    const auto show = [&](std::size_t pixel) {
      if (!(focusDepth[pixel] < infinity))
        return;
      const int column = static_cast<int>(pixel % static_cast<std::size_t>(width));
      const int row = static_cast<int>(pixel / static_cast<std::size_t>(width));
      const Ray ray = scene.camera.ray(column + 0.5, row + 0.5);
      const double focus = focusDepth[pixel] / scene.camera.depthPerLength(ray);
      const Interval range = visible(scene.clip, ray);
      const double rounding = 0.5 * scene.camera.pixelPitch();
      if (range.empty() || range.begin > focus + rounding || range.end < focus - rounding)
        return; // the focus itself is cut away
      Random random(seed, pixel, 0);
      Counters counters;
      shown[pixel] = tracker.transmittance(ray, {range.begin, focus}, random, counters);
    };
    tbb::parallel_for(std::size_t{0}, focusDepth.size(), show);
    const auto pixels = std::count_if(focusDepth.begin(), focusDepth.end(),
                                      [](double depth) { return depth < infinity; });
    return pixels > 0
               ? std::accumulate(shown.begin(), shown.end(), 0.0) / static_cast<double>(pixels)
               : 0.0;
  });
}

} // namespace fenestra
