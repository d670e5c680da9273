#pragma once
// Lights that a ray can hit (environments, skies, areas), and directional lights, which it cannot.

#include "Scatter.h"
#include "View.h"

namespace fenestra::oracle {

/// Area light in world space, mm.
struct PlacedArea {
  AreaLight::Shape shape;
  Vec3 center, normal, right, up;
  Vec2 size; ///< full edges; for a disk, the diameter in both
  Rgb radiance;

  double area() const;
  /// Distance at which a ray hits the light from either side; infinity: ray misses.
  double meeting(const Ray& ray) const;
};

class Lights {
public:
  Lights(const std::vector<Light>& lights, const Grid& volume, const View& view);

  /// Radiance of all environments and skies; `direction`: of travel, toward the environment.
  Rgb environment(const Vec3& direction) const;
  /// Radiance of all area lights that a ray hits on their emitting side before `end`, mm.
  Rgb areas(const Ray& ray, double end) const;
  bool hasAreas() const { return !m_areas.empty(); }
  /// Direction from `point` to a uniform point on one of the area lights; areaDensity: its pdf per
  /// steradian.
  Vec3 towardArea(const Vec3& point, Generator& generator) const;
  double areaDensity(const Ray& ray) const;
  const std::vector<DirectionalLight>& directionals() const { return m_directionals; }

private:
  std::vector<EnvironmentLight> m_environments;
  std::vector<SkyLight> m_skies; ///< in world space
  std::vector<DirectionalLight> m_directionals;
  std::vector<PlacedArea> m_areas;
};

} // namespace fenestra::oracle
