#pragma once
// The readable truth: one scalar, unbiased path through the clipped volume. Everything faster must
// agree with it.
//
// Radiative transfer, one extinction for the three channels:
//   L(x, w) = T(x, exit) L_light(w) + ∫ T(x, y) sigma_t(y) ∫ f(y, w, w') L(y, w') dw' dy
// with f = albedo * phase function, or surface lobes (design, section 1). Collisions are drawn from
// T sigma_t, so a path's weight changes by f / pdf alone; at each collision one light is sampled
// (next-event estimation) and combined with what the scattered ray itself meets by the balance
// heuristic (Veach 1997, eq. 9.8).

#include "film/Film.h"
#include "lights/LightSet.h"
#include "medium/Scattering.h"
#include "tracking/Tracker.h"
#include "transport/Background.h"

#include <atomic>
#include <optional>

namespace fenestra {

struct PathSettings {
  Background background;
  std::uint64_t bounces = std::numeric_limits<std::uint64_t>::max(); ///< scatterings, at most
  bool wantNormals = false; ///< fill PathSample::normal even where shading needs no gradient
};

/// `Distances` draws free paths and estimates transmittance, with Tracker's members.
template <typename Voxel, typename Distances = Tracker<Voxel>>
class PathEstimator {
public:
  PathEstimator(const Grid& grid, const Medium<Voxel>& medium, const Distances& tracker,
                const LightSet& lights, const Camera& camera, const Clip& clip,
                const PathSettings& settings, const std::atomic<bool>& stop)
      : m_worldToIndex(grid.worldToIndex),
        m_medium(medium),
        m_tracker(tracker),
        m_lights(lights),
        m_camera(camera),
        m_clip(clip),
        m_settings(settings),
        m_stop(stop) {}

  /// One path through raster position (column, row). Nothing where `stop` became true during a long
  /// one: with albedo 1 in a dense medium a path can take minutes.
  std::optional<PathSample> trace(double column, double row, Random& random,
                                  Counters& counters) const {
    ++counters.paths;
    PathSample result;
    Ray ray = m_camera.ray(column, row);
    Interval range = visible(m_clip, ray);
    Rgb weight = Rgb::Ones();
    double scatterPdf = 0.0;
    for (std::uint64_t bounce = 0;; ++bounce) {
      if (bounce % bouncesBetweenLooks == bouncesBetweenLooks - 1 && m_stop)
        return std::nullopt;
      const double distance = m_tracker.sampleCollision(ray, range, random, counters);
      if (bounce == 0 && distance == infinity)
        return escaped(ray, row, result);
      if (bounce > 0)
        result.radiance += weight * arriving(ray, distance, scatterPdf);
      if (distance == infinity || bounce >= m_settings.bounces)
        return result;

      ++counters.collisions;
      const Vec3 point = ray.at(distance);
      const Matter matter =
          m_medium.matter(m_worldToIndex * point, bounce == 0 && m_settings.wantNormals);
      if (bounce == 0)
        recordFirst(ray, distance, matter, result);

      const Scattering scattering = chooseScattering(ray.direction, matter, random);
      result.radiance += weight * sampledLight(point, scattering, random, counters);

      const ScatterSample scattered = scatterSample(scattering, random);
      weight *= scattered.weight;
      if (!survives(weight, random))
        return result;
      scatterPdf = scattered.pdf;
      ray = {point, scattered.outgoing};
      range = {};
    }
  }

private:
  static constexpr std::uint64_t bouncesBetweenLooks = 256;

  /// An eye ray that met nothing shows the background: one colour over a whole row of pixels, so
  /// that where a sample falls inside its pixel adds no noise.
  PathSample escaped(const Ray& ray, double row, PathSample& result) const {
    const Background& background = m_settings.background;
    switch (background.kind) {
    case Background::Kind::color:
      result.radiance = background.color;
      break;
    case Background::Kind::gradient:
      result.radiance = background.at(1.0 - (std::floor(row) + 0.5) / m_camera.height());
      break;
    case Background::Kind::transparent:
      result.alpha = 0.0;
      break;
    case Background::Kind::environment:
      result.radiance = m_lights.environment(ray.direction).radiance;
      break;
    }
    return result;
  }

  void recordFirst(const Ray& ray, double distance, const Matter& matter,
                   PathSample& result) const {
    result.depth = distance * m_camera.depthPerLength(ray);
    result.albedo = matter.albedo;
    const double slope = matter.gradient.norm();
    if (slope > 0.0)
      result.normal = matter.gradient / (ray.direction.dot(matter.gradient) < 0.0 ? slope : -slope);
  }

  Scattering chooseScattering(const Vec3& incoming, const Matter& matter, Random& random) const {
    const TransferFunction& transfer = m_medium.transfer();
    if (matter.surfaceProbability > 0.0 && random.uniform() < matter.surfaceProbability)
      return SurfaceScattering(incoming, matter.gradient, *transfer.shading, matter.albedo);
    return PhaseScattering(incoming, transfer.g, matter.albedo);
  }

  /// Next-event estimation: one light, seen through the volume, weighted against scattering into
  /// it.
  Rgb sampledLight(const Vec3& point, const Scattering& scattering, Random& random,
                   Counters& counters) const {
    const std::optional<LightSample> light = m_lights.sample(point, random);
    if (!light)
      return Rgb::Zero();
    const Rgb factor = scatterEvaluate(scattering, light->direction);
    if (!(factor.maxCoeff() > 0.0) || !(light->radiance.maxCoeff() > 0.0))
      return Rgb::Zero();
    const double other = light->delta ? 0.0 : fenestra::scatterPdf(scattering, light->direction);
    const double visibility = m_tracker.transmittance({point, light->direction},
                                                      {0.0, light->distance}, random, counters);
    return factor * light->radiance * (visibility / (light->pdf + other));
  }

  /// Light that a scattered ray meets by itself before its next collision (or at infinity).
  Rgb arriving(const Ray& ray, double distance, double scatterPdf) const {
    const auto weigh = [&](const LightArrival& arrival) -> Rgb {
      return arrival.radiance * (scatterPdf / (scatterPdf + arrival.pdf));
    };
    Rgb sum = m_lights.areaArrivals(ray, distance, weigh);
    if (distance == infinity)
      sum += weigh(m_lights.environment(ray.direction));
    return sum;
  }

  /// Russian roulette on what the path can still contribute.
  static bool survives(Rgb& weight, Random& random) {
    constexpr double rouletteBelow = 0.5;
    const double most = weight.maxCoeff();
    if (most >= rouletteBelow)
      return true;
    const double chance = most / rouletteBelow;
    if (!(random.uniform() < chance))
      return false;
    weight /= chance;
    return true;
  }

  Affine m_worldToIndex;
  const Medium<Voxel>& m_medium;
  const Distances& m_tracker;
  const LightSet& m_lights;
  const Camera& m_camera;
  const Clip& m_clip;
  const PathSettings& m_settings;
  const std::atomic<bool>& m_stop;
};

} // namespace fenestra
