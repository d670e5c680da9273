#pragma once
// The steps of a path: start, vertex (where emitted light is added), scattering. The scalar
// reference; integrator/simd/PathSteps does the same for many paths at once.
//
// Radiative transfer, one extinction sigma_t for the three channels, with the radiance L at a point
// x from a direction w, and the transmittance T between two points:
//   L(x, w) = T(x, exit) L_light(w) + ∫ T(x, y) sigma_t(y) ∫ f(y, w, w') L(y, w') dw' dy
// with f = albedo * phase function, or surface lobes. Collisions are sampled with pdf T sigma_t, so
// that throughput changes by f / pdf alone. Each vertex samples one light (next-event estimation),
// which is combined with emission along the scattered ray by the balance heuristic (Veach 1997,
// eq. 9.8). A scattered ray starts at its collision: null collisions need no offset.
#include "base/Sampler.h"
#include "image/Film.h"
#include "integrator/scalar/CameraRays.h"
#include "integrator/scalar/ClippedMedium.h"
#include "integrator/scalar/Counters.h"
#include "model/lights/LightSet.h"
#include "model/medium/Scattering.h"

#include <optional>

namespace fenestra::core::scalar {
#include "formulas/Paths.inl"
} // namespace fenestra::core::scalar

namespace fenestra::core {

struct PathSettings {
  Background background;
  std::uint64_t bounces = std::numeric_limits<std::uint64_t>::max(); ///< maximum of scatterings
  bool wantNormals = false; ///< fill PathSample::normal even without surface shading
};

/// State of a path: its next ray, and the sample accumulated so far.
struct Path {
  Random random;
  Vec2 uFlight;    ///< random numbers of the next tentative collision: optical depth, acceptance
  Vec2 uDirection; ///< random numbers of the next direction
  Vec2 uChoices;   ///< random numbers at the next vertex: surface or phase function; light
  double row;      ///< raster row of the camera ray
  Ray ray;         ///< world space
  Interval range;  ///< part of the ray that the clip leaves, mm
  Rgb throughput = Rgb::Ones();
  double scatterPdf = 0.0;   ///< of the ray's direction, per steradian
  std::uint64_t bounces = 0; ///< scatterings so far
  PathSample sample = {};
};

/// Ray toward a sampled light, which contributes `radiance` times the transmittance along the ray.
struct ShadowRay {
  Ray ray;         ///< world space
  double distance; ///< to the light, mm; infinity for lights at infinity
  Rgb radiance;
};

/// Non-owning. The random numbers of the first vertex are given (PrimarySamples); all later ones
/// come from the path's own stream, in the order of its steps.
template <typename Voxel>
class PathSteps {
public:
  PathSteps(const Grid& grid, const Medium<Voxel>& medium, const LightSet& lights,
            const Camera& camera, const Clip& clip, const PathSettings& settings)
      : m_worldToIndex(grid.worldToIndex),
        m_medium(medium),
        m_clip(clip),
        m_lights(lights),
        m_cameraRays(camera, cameraRayClip(clip, medium.mixture()), lights, settings.background),
        m_settings(settings) {}

  /// Starts a path through raster position (column, row).
  Path begin(double column, double row, const PrimarySamples& numbers) const {
    const Ray ray = m_cameraRays.ray(column, row);
    const Vec2 flight{toUniform(numbers.opticalDepth), toUniform(numbers.acceptance)};
    return {Random(numbers.pathSeed),    flight, toUniform2(numbers.direction),
            toUniform2(numbers.choices), row,    ray,
            m_cameraRays.range(ray)};
  }

  /// Ends the path's ray after `distance` mm at a collision, or at infinity without one, and adds
  /// the light emitted along it. Returns true if the path scatters there.
  bool handleVertex(Path& path, double distance) const {
    if (path.bounces > 0)
      path.sample.radiance +=
          path.throughput * emittedAlongRay(path.ray, distance, path.scatterPdf);
    else if (distance == infinity)
      path.sample = m_cameraRays.sampleBackground(path.row, path.ray.direction);
    return distance < infinity && path.bounces < m_settings.bounces;
  }

  /// Scatters the path at its collision after `distance` mm: samples a light and a direction, and
  /// sets the next ray. Throughput 0 ends the path.
  std::optional<ShadowRay> scatter(Path& path, double distance, Counters& counters) const {
    const Vec3 point = path.ray.at(distance);
    const bool first = path.bounces == 0;
    const bool wantGradient = first && m_settings.wantNormals;
    counters.gradients += m_medium.needsGradient(wantGradient) ? 1 : 0;
    const MediumSample medium =
        sampleMedium(m_medium, m_clip, point, m_worldToIndex * point, wantGradient, path.random);
    if (first)
      recordFirstHit(path, distance, medium);
    const Scattering scattering = chooseScattering(path.ray.direction, medium, path.uChoices.x());
    std::optional<ShadowRay> light = sampleLight(point, scattering, path);
    const double choice = scattering.isSurface() ? path.random.uniform() : 0.0;
    const ScatterSample scattered = scattering.sample(choice, path.uDirection);
    path.uDirection = path.random.uniform2();
    path.uChoices = path.random.uniform2();
    path.throughput *= scattered.weight;
    playRoulette(path);
    path.scatterPdf = scattered.pdf;
    path.ray = {point, scattered.outgoing};
    path.range = {};
    path.uFlight = path.random.uniform2();
    ++path.bounces;
    path.sample.scatterings += 1.0;
    return light;
  }

  static bool hasEnded(const Path& path) { return !(path.throughput.maxCoeff() > 0.0); }

private:
  void recordFirstHit(Path& path, double distance, const MediumSample& medium) const {
    PathSample& sample = path.sample;
    sample.depth = m_cameraRays.depth(path.ray, distance);
    sample.albedo = medium.albedo;
    sample.normal =
        toVector(scalar::makeNormal(medium.gradient, path.ray.direction.dot(medium.gradient), 1.0));
  }

  static Scattering chooseScattering(const Vec3& incoming, const MediumSample& medium,
                                     double choice) {
    const TransferFunction& transfer = *medium.transfer;
    if (choice < medium.surfaceProbability)
      return {incoming, medium.gradient, *transfer.shading, medium.albedo};
    return {incoming, transfer.g, medium.albedo};
  }

  /// Next-event estimation: samples one light, weighted by the balance heuristic against scattering
  /// toward it. Its visibility is the transmittance of the returned ray.
  std::optional<ShadowRay> sampleLight(const Vec3& point, const Scattering& scattering,
                                       Path& path) const {
    const std::optional<LightSample> light =
        m_lights.sample(point, path.uChoices.y(), path.random.uniform2());
    if (!light)
      return std::nullopt;
    const Rgb radiance =
        toColor(scalar::weighLight(light->radiance, light->pdf, light->isDelta,
                                   scattering.evaluate(light->direction), path.throughput));
    if (!(radiance.maxCoeff() > 0.0))
      return std::nullopt;
    return ShadowRay{{point, light->direction}, light->distance, radiance};
  }

  /// Radiance emitted along a scattered ray up to its next collision, weighted against
  /// next-event estimation.
  Rgb emittedAlongRay(const Ray& ray, double distance, double scatterPdf) const {
    const auto weigh = [&](const EmitterHit& hit) -> Rgb {
      return hit.radiance * scalar::weighScattering(scatterPdf, hit.pdf);
    };
    Rgb sum = m_lights.sumEmitterHits(ray, distance, weigh);
    if (distance == infinity)
      sum += weigh(m_lights.evaluateEnvironment(ray.direction));
    return sum;
  }

  static void playRoulette(Path& path) {
    const double chance = scalar::keepProbability(path.throughput);
    if (chance >= 1.0)
      return;
    if (path.random.uniform() < chance)
      path.throughput /= chance;
    else
      path.throughput.setZero();
  }

  Affine m_worldToIndex;
  const Medium<Voxel>& m_medium;
  const Clip& m_clip;
  const LightSet& m_lights;
  CameraRays m_cameraRays;
  const PathSettings& m_settings;
};

} // namespace fenestra::core
