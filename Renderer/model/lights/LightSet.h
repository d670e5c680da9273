#pragma once
// The lights of a scene: next-event estimation samples; and, for directions sampled by scattering,
// the emitted radiance and the density of sample() (for multiple importance sampling).
// Constant environments and skies are never sampled: scattered rays reach them without shadow rays.
// Area lights and spheres only emit: they block no light, and camera rays do not see them.

#include "base/Random.h"
#include "base/ScalarMath.h"
#include "model/camera/Camera.h"
#include "model/lights/EnvironmentSampler.h"
#include "model/lights/LightTables.h"
#include "model/volume/Grid.h"

#include <optional>

namespace fenestra::core::scalar {
#include "model/lights/LightLoops-inl.h"
} // namespace fenestra::core::scalar

namespace fenestra::core {

struct LightSample {
  Vec3 direction;  ///< unit, from the point toward the light
  double distance; ///< mm; infinity for environment and directional lights
  Rgb radiance;    ///< incident; for a directional light its irradiance
  double pdf;      ///< per steradian, including the light's pmf; for a directional light the pmf
                   ///< alone
  bool isDelta;    ///< true for a directional light: scattering never samples its direction
};

/// Radiance along a direction, and the density of sample() for that direction.
struct EmitterHit {
  Rgb radiance = Rgb::Zero();
  double pdf = 0.0;
};

/// An environment light with its selection probability.
struct PlacedEnvironment {
  EnvironmentSampler sampler;
  double pmf; ///< probability that LightSet::sample() selects it; 0: never
};

class LightSet {
public:
  /// Lights in the camera's frame are placed around the volume's center, lights in the focus's
  /// frame around `focus`, its centroid in world space.
  LightSet(const std::vector<Light>& lights, const Grid& volume, const Camera& camera,
           const Vec3& focus = Vec3::Zero());

  /// Samples one light, selected by pmf. Empty if that light does not reach the point, or if there
  /// is no light to sample.
  std::optional<LightSample> sample(const Vec3& point, Random& random) const {
    const double choice = random.uniform();
    return sample(point, choice, random.uniform2());
  }
  /// `choice`, in [0, 1), selects the light.
  std::optional<LightSample> sample(const Vec3& point, double choice, const Vec2& u) const;

  /// Total radiance and density of the environments and skies.
  EmitterHit evaluateEnvironment(const Vec3& direction) const;

  /// Sum of weigh(hit) over all area lights and spheres that the ray hits before `end` (mm).
  template <typename Weigh>
  Rgb sumEmitterHits(const Ray& ray, double end, Weigh&& weigh) const {
    Rgb sum = Rgb::Zero();
    scalar::intersectLights(m_tables, true, ray.origin, ray.direction, end,
                            [&](scalar::LaneMask, const scalar::Float3& radiance, double pdf) {
                              sum += weigh(EmitterHit{toColor(radiance), pdf});
                            });
    return sum;
  }

  /// All placed lights except environment maps.
  const LightTables<double>& tables() const { return m_tables; }
  const std::vector<PlacedEnvironment>& environments() const { return m_environments; }
  /// True if any environment is not constant.
  bool hasMaps() const;

private:
  /// Samples an environment map; empty without maps. `choice`: a uniform number minus the pmf of
  /// all area, directional and sphere lights.
  std::optional<LightSample> sampleEnvironment(double choice, const Vec2& u) const;

  /// A frame's axes, origin (mm) and unit of length (mm) in world space.
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

} // namespace fenestra::core
