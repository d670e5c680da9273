#pragma once
// The lights of a scene, ready to be sampled: next-event estimation draws from them, and directions
// that scattering drew ask for their radiance and for the density with which sample() would have
// drawn the same (for multiple importance sampling). A constant environment is never drawn:
// scattered rays find it as well, and need no second ray for it. Area lights are emitters only:
// they block nothing, and an eye ray does not see them.

#include "base/Random.h"
#include "model/camera/Camera.h"
#include "model/lights/EnvironmentSampler.h"
#include "model/lights/Light.h"
#include "model/volume/Grid.h"

#include <optional>

namespace fenestra {

struct LightSample {
  Vec3 direction;  ///< unit, from the point toward the light
  double distance; ///< mm; infinity for environment and directional lights
  Rgb radiance;    ///< arriving; for a directional light its irradiance
  double pdf;      ///< per steradian, the choice of the light included; for a directional light
                   ///< the chance of that choice alone
  bool delta;      ///< a directional light: scattering can never draw its direction
};

/// Radiance that arrives along a direction, and the density of sample() there.
struct LightArrival {
  Rgb radiance = Rgb::Zero();
  double pdf = 0.0;
};

/// An area light in the world.
struct PlacedAreaLight {
  AreaLight::Shape shape;
  Vec3 center, normal, right, up; ///< right, up: unit edges' directions
  Vec2 half;                      ///< half edges, or the radius (twice), mm
  double area;                    ///< mm^2
  Rgb radiance;
  double share; ///< chance that LightSet::sample() takes this light

  std::optional<LightSample> sample(const Vec3& point, const Vec2& u) const;
  std::optional<LightArrival> arrival(const Ray& ray, double end) const;
};
struct PlacedDirectionalLight {
  Vec3 toward; ///< from the scene to the light
  Rgb irradiance;
  double share;
};

class LightSet {
public:
  /// Lights in the camera's frame are placed around the volume's centre.
  LightSet(const std::vector<Light>& lights, const Grid& volume, const Camera& camera);

  /// None where the drawn light does not reach the point, or there is no light to draw.
  std::optional<LightSample> sample(const Vec3& point, Random& random) const {
    const double choice = random.uniform();
    return sample(point, choice, random.uniform2());
  }
  /// `choice` decides on the light.
  std::optional<LightSample> sample(const Vec3& point, double choice, const Vec2& u) const;

  /// Of an environment, where there is one to draw.
  std::optional<LightSample> sampleEnvironment(double choice, const Vec2& u) const;

  /// Of all environments together.
  LightArrival environment(const Vec3& direction) const;

  /// All area lights that the ray meets before `end` (mm), summed with `weigh(arrival)` each.
  template <typename Weigh>
  Rgb areaArrivals(const Ray& ray, double end, Weigh&& weigh) const {
    Rgb sum = Rgb::Zero();
    for (const PlacedAreaLight& light : m_areas)
      if (const std::optional<LightArrival> arrival = light.arrival(ray, end))
        sum += weigh(*arrival);
    return sum;
  }

  const std::vector<PlacedAreaLight>& areas() const { return m_areas; }
  const std::vector<PlacedDirectionalLight>& directionals() const { return m_directionals; }
  /// The constant environments' radiance together.
  Rgb constantEnvironment() const;
  /// Whether there are environments that are not constant.
  bool hasMaps() const;

private:
  struct SharedEnvironment {
    EnvironmentSampler sampler;
    double share; ///< 0: never drawn
  };

  void place(const AreaLight& light, const Grid& volume, const Camera& camera);
  void chooseShares(const Vec3& center);

  std::vector<PlacedAreaLight> m_areas;
  std::vector<PlacedDirectionalLight> m_directionals;
  std::vector<SharedEnvironment> m_environments;
};

} // namespace fenestra
