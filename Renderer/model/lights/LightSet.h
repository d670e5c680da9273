#pragma once
// The lights of a scene: samples for next-event estimation; and, for directions drawn by
// scattering, the arriving radiance and the density of sample() (for multiple importance sampling).
// A constant environment and a sky are never sampled: scattered rays meet them anyway, without a
// second ray.
// Area lights and spheres only emit: they block nothing, and eye rays do not see them.

#include "base/Random.h"
#include "base/ScalarMath.h"
#include "model/camera/Camera.h"
#include "model/lights/EnvironmentSampler.h"
#include "model/lights/LightTables.h"
#include "model/volume/Grid.h"

#include <optional>

namespace fenestra::scalar {
#include "model/lights/LightFormulas-inl.h"
} // namespace fenestra::scalar

namespace fenestra {

struct LightSample {
  Vec3 direction;  ///< unit, from the point toward the light
  double distance; ///< mm; infinity for environment and directional lights
  Rgb radiance;    ///< arriving; for a directional light its irradiance
  double pdf;      ///< per steradian, the choice of the light included; for a directional light
                   ///< the probability of that choice alone
  bool isDelta;    ///< true for a directional light: scattering never draws its direction
};

/// Radiance arriving from a direction, and the density of sample() for that direction.
struct EmitterHit {
  Rgb radiance = Rgb::Zero();
  double pdf = 0.0;
};

/// An environment in the world.
struct PlacedEnvironment {
  EnvironmentSampler sampler;
  double pmf; ///< probability that LightSet::sample() takes this light; 0: never sampled
};

class LightSet {
public:
  /// Lights in the camera's frame are placed around the volume's centre, lights in the focus's
  /// frame around `focus`, its centroid in the world.
  LightSet(const std::vector<Light>& lights, const Grid& volume, const Camera& camera,
           const Vec3& focus = Vec3::Zero());

  /// Sample of one light, chosen by its share; empty if that light does not reach the point, or
  /// without lights to sample.
  std::optional<LightSample> sample(const Vec3& point, Random& random) const {
    const double choice = random.uniform();
    return sample(point, choice, random.uniform2());
  }
  /// `choice`, in [0, 1), selects the light.
  std::optional<LightSample> sample(const Vec3& point, double choice, const Vec2& u) const;

  /// Radiance and density of all environments and skies together.
  EmitterHit evaluateEnvironment(const Vec3& direction) const;

  /// Sum of weigh(arrival) over all area lights and spheres that the ray meets before `end` (mm).
  template <typename Weigh>
  Rgb sumEmitterHits(const Ray& ray, double end, Weigh&& weigh) const {
    Rgb sum = Rgb::Zero();
    scalar::intersectLights(m_tables, true, ray.origin, ray.direction, end,
                            [&](scalar::ScalarMask, const scalar::Float3& radiance, double pdf) {
                              sum += weigh(EmitterHit{toColor(radiance), pdf});
                            });
    return sum;
  }

  /// All lights in the world but environment maps.
  const LightTables<double>& tables() const { return m_tables; }
  const std::vector<PlacedEnvironment>& environments() const { return m_environments; }
  /// True if any environment is not constant.
  bool hasMaps() const;

private:
  /// Sample of an environment map; empty without maps. `choice`: a uniform number less the shares
  /// of all area and directional lights and spheres.
  std::optional<LightSample> sampleEnvironment(double choice, const Vec2& u) const;

  /// A frame's axes, its origin (mm) and its unit of length (mm) in the world.
  struct WorldFrame {
    Mat3 axes = Mat3::Identity();
    Vec3 origin = Vec3::Zero();
    double unit = 1.0;
  };
  void place(const EnvironmentLight& light);
  void place(const DirectionalLight& light);
  void place(const SkyLight& light, const WorldFrame& frame);
  void place(const AreaLight& light, const WorldFrame& frame);
  void place(const SphereLight& light, const WorldFrame& frame);
  void computePmfs(const Vec3& center);

  LightTables<double> m_tables;
  std::vector<PlacedEnvironment> m_environments;
};

} // namespace fenestra
