#pragma once
// Trackers of other renderers, used in Fenestra's path integrator: delta tracking with one majorant
// for the volume, and ray marching as in medical renderers. Both have the members of Tracker.

#include "integrator/render/Render.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace fenestra::core::benchmarks {

/// Part of a ray inside the volume; distances start at the entry point.
struct Crossing {
  double start, length; ///< mm; length <= 0: the ray misses
  Ray world, index;

  Crossing(const Domain& domain, const Ray& ray, const Interval& range) {
    const Affine& worldToIndex = domain.grid().worldToIndex;
    const Interval inside = domain.clip(transformRay(worldToIndex, ray), range);
    start = inside.begin;
    length = inside.isEmpty() ? 0.0 : inside.end - inside.begin;
    world = {length > 0.0 ? ray.at(start) : ray.origin, ray.direction};
    index = transformRay(worldToIndex, world);
  }
};

/// Delta and ratio tracking (Woodcock et al. 1965; Novak et al. 2014) without a majorant grid.
template <typename Voxel>
class GlobalTracker {
public:
  GlobalTracker(const SceneView& scene, const Medium<Voxel>& medium)
      : m_domain(scene.volume.grid, scene.crop),
        m_medium(medium),
        m_clip(scene.clip),
        m_majorant(maxExtinction(scene)) {}

  double sampleCollision(const Ray& ray, const Interval& range, const Vec2& first, Random& random,
                         Counters& counters) const {
    const auto walk = [&](auto&& visit) {
      visitTentative(ray, range, toExponential(first.x()), random, counters, visit);
    };
    return findRealCollision(walk, first.y(), random);
  }

  double transmittance(const Ray& ray, const Interval& range, Random& random,
                       Counters& counters) const {
    const auto walk = [&](auto&& visit) {
      visitTentative(ray, range, random.exponential(), random, counters, visit);
    };
    return trackRatio(walk, random);
  }

private:
  /// Maximum extinction over the volume's scalar range, mm^-1.
  static double maxExtinction(const SceneView& scene) {
    const TransferFunction& transfer = scene.transfer;
    const double greatest =
        transfer.extinction.range(scene.volume.minimum, scene.volume.maximum)[1];
    return transfer.gradientOpacity ? greatest * transfer.gradientOpacity->range(0.0, infinity)[1]
                                    : greatest;
  }

  template <typename Visit>
  void visitTentative(const Ray& ray, const Interval& range, double opticalDepth, Random& random,
                      Counters& counters, Visit&& visit) const {
    const Crossing crossing(m_domain, ray, range);
    if (m_majorant == 0.0)
      return;
    for (double t = opticalDepth / m_majorant; t < crossing.length;
         t += random.exponential() / m_majorant) {
      double extinction = clipWeight(m_clip, crossing.world.at(t));
      if (extinction > 0.0) {
        ++counters.lookups;
        extinction *= m_medium.extinction(crossing.index.at(t));
      }
      if (!visit(crossing.start + t, extinction / m_majorant))
        return;
    }
  }

  Domain m_domain;
  const Medium<Voxel>& m_medium;
  const Clip& m_clip;
  double m_majorant; ///< mm^-1
};

/// Ray marching with fixed steps from a random start (Kroes, Post, Botha 2012, section 3, as in
/// Exposure Render). A path collides at the sample where the accumulated optical depth exceeds an
/// exponential variate. Transmittance is exp(-sum), or 0 below 1/1000. Biased: the medium between
/// samples is missed, and exp(-sum) is too large on average.
template <typename Voxel>
class MarchingTracker {
public:
  /// `step`: in units of the shortest voxel edge, as in medical renderers.
  MarchingTracker(const SceneView& scene, const Medium<Voxel>& medium, double step)
      : m_domain(scene.volume.grid, scene.crop),
        m_medium(medium),
        m_clip(scene.clip),
        m_step(step * scene.volume.grid.worldToIndex.inverse().linear().columnNorms().minCoeff()) {}

  double sampleCollision(const Ray& ray, const Interval& range, const Vec2& first, Random& random,
                         Counters& counters) const {
    const double target = toExponential(first.x());
    double distance = infinity;
    march(ray, range, random, counters, [&](double t, double opticalDepth) {
      if (opticalDepth < target)
        return true;
      distance = t;
      return false;
    });
    return distance;
  }

  double transmittance(const Ray& ray, const Interval& range, Random& random,
                       Counters& counters) const {
    constexpr double opaque = 6.9; // ln 1000
    double sum = 0.0;
    march(ray, range, random, counters, [&](double, double opticalDepth) {
      sum = opticalDepth;
      return sum < opaque;
    });
    return sum < opaque ? std::exp(-sum) : 0.0;
  }

private:
  /// Calls visit(t, optical depth including the sample at t) until it returns false.
  template <typename Visit>
  void march(const Ray& ray, const Interval& range, Random& random, Counters& counters,
             Visit&& visit) const {
    const Crossing crossing(m_domain, ray, range);
    double opticalDepth = 0.0;
    for (double t = random.uniform() * m_step; t < crossing.length; t += m_step) {
      if (!(clipWeight(m_clip, crossing.world.at(t)) > 0.0))
        continue;
      ++counters.lookups;
      const double extinction = m_medium.extinction(crossing.index.at(t));
      opticalDepth += extinction * m_step;
      if (extinction > 0.0 && !visit(crossing.start + t, opticalDepth))
        return;
    }
  }

  Domain m_domain;
  const Medium<Voxel>& m_medium;
  const Clip& m_clip;
  double m_step; ///< mm
};

/// Renders independent samples of every pixel with the scalar estimator and the tracker that
/// `makeTracker(medium)` returns. Stops only at settings.samples.
template <typename MakeTracker>
Film traceImage(const SceneView& scene, const RenderSettings& settings, MakeTracker&& makeTracker) {
  Film film(scene.camera.width(), scene.camera.height());
  const Sampler sampler(Sampling::independent, settings.seed);
  const std::atomic<bool> stop = false;
  const auto tracePixels = [&](const auto& estimator) {
    tbb::parallel_for(0, film.height(), [&](int row) {
      Counters counters;
      for (int column = 0; column < film.width(); ++column)
        for (std::uint64_t sample = 0; sample < settings.samples; ++sample) {
          const PrimarySamples numbers = sampler.generate(film.index(column, row), sample);
          const Vec2 jitter = toUniform2(numbers.position);
          film.at(column, row)
              .add(*estimator.trace(column + jitter.x(), row + jitter.y(), numbers, counters));
        }
    });
  };
  tbb::task_arena arena(settings.threads > 0 ? settings.threads : tbb::task_arena::automatic);
  arena.execute([&] {
    std::visit(
        [&](const auto& voxels) {
          const Medium medium(scene.volume.grid, voxels, scene.transfer);
          const auto tracker = makeTracker(medium);
          tracePixels(PathIntegrator(scene.volume.grid, medium, tracker, scene.lights, scene.camera,
                                     scene.clip, settings.path, stop));
        },
        scene.volume.voxels);
  });
  return film;
}

} // namespace fenestra::core::benchmarks
