#include "render/Render.h"

#include "core/Stopwatch.h"

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

/// Passes grow, so that a picture is there early and overhead stays small later; their sizes are
/// fixed, so that a stop by noise falls on the same sample count on every machine.
std::uint64_t passSize(std::uint64_t done, const RenderSettings& settings) {
  constexpr std::uint64_t largest = 16;
  const std::uint64_t grown = std::clamp<std::uint64_t>(done, 1, largest);
  const std::uint64_t wanted = settings.passSamples > 0 ? settings.passSamples : grown;
  return std::min(wanted, settings.samples - done);
}

/// Samples first … first + count - 1 of every pixel. Returns false when it was stopped before all
/// were done.
template <typename Estimator>
bool renderPass(const Estimator& estimator, std::uint64_t first, std::uint64_t count,
                std::uint64_t seed, Film& film, Counters& total, RenderMonitor& monitor) {
  tbb::combinable<Counters> counters;
  std::atomic<bool> whole = true;
  const auto renderTile = [&](const tbb::blocked_range2d<int>& tile) {
    Counters& local = counters.local();
    for (int row = tile.rows().begin(); row < tile.rows().end(); ++row) {
      for (int column = tile.cols().begin(); column < tile.cols().end(); ++column) {
        const auto pixel =
            static_cast<std::uint64_t>(row) * static_cast<std::uint64_t>(film.width()) +
            static_cast<std::uint64_t>(column);
        for (std::uint64_t sample = first; sample < first + count; ++sample) {
          if (monitor.stop.load(std::memory_order_relaxed)) {
            whole = false;
            return;
          }
          Random random(seed, pixel, sample);
          const Vec2 jitter = random.uniform2();
          const std::optional<PathSample> path =
              estimator.trace(column + jitter.x(), row + jitter.y(), random, local);
          if (!path) {
            whole = false;
            return;
          }
          film.at(column, row).add(*path);
        }
      }
      const auto columns = static_cast<std::uint64_t>(tile.cols().end() - tile.cols().begin());
      monitor.paths.fetch_add(count * columns, std::memory_order_relaxed);
    }
  };
  constexpr int tileSize = 16;
  tbb::parallel_for(
      tbb::blocked_range2d<int>(0, film.height(), tileSize, 0, film.width(), tileSize), renderTile);
  counters.combine_each([&](const Counters& local) { total += local; });
  return whole;
}

template <typename Estimator>
RenderResult renderPasses(const Estimator& estimator, const RenderScene& scene,
                          const RenderSettings& settings, RenderMonitor& monitor) {
  RenderResult result{Film(scene.camera.width(), scene.camera.height()), {}, {}, 0};
  const Stopwatch watch;
  while (result.finishedSamples < settings.samples) {
    std::uint64_t count = passSize(result.finishedSamples, settings);
    if (settings.seconds < infinity && result.finishedSamples > 0) {
      const double elapsed = watch.seconds();
      const double perSample = elapsed / static_cast<double>(result.finishedSamples);
      const double affordable = (settings.seconds - elapsed) / perSample;
      if (affordable < 1.0) {
        result.reason = StopReason::seconds;
        return result;
      }
      count = std::min(count, static_cast<std::uint64_t>(std::min(affordable, 1e9)));
    }
    if (!renderPass(estimator, result.finishedSamples, count, settings.seed, result.film,
                    result.counters, monitor)) {
      result.reason = StopReason::request;
      return result;
    }
    result.finishedSamples += count;
    monitor.noise = result.film.noise();
    if (result.finishedSamples >= leastForNoise && monitor.noise <= settings.noise) {
      result.reason = StopReason::noise;
      return result;
    }
  }
  return result;
}

} // namespace

RenderResult render(const RenderScene& scene, const RenderSettings& settings,
                    RenderMonitor& monitor) {
  const int cores = tbb::info::default_concurrency(); // TBB complains about more
  tbb::task_arena arena(settings.threads > 0 ? std::min(settings.threads, cores) : cores);
  return arena.execute([&] {
    return withMedium(scene, [&](const auto& medium, const auto& tracker) {
      const PathEstimator estimator(scene.volume.grid, medium, tracker, scene.lights, scene.camera,
                                    scene.clip, settings.path, monitor.stop);
      return renderPasses(estimator, scene, settings, monitor);
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
