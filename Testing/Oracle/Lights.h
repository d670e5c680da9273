#pragma once
// Lights that a ray can hit (environments, skies, areas, spheres) and directional lights, which no
// ray hits.

#include "Scatter.h"
#include "View.h"

namespace fenestra::core::oracle {

/// Area light in world space, mm.
struct PlacedArea {
  AreaLight::Shape shape;
  Vec3 center, normal, right, up;
  Vec2 size; ///< full edges; for a disk, both are the diameter
  Rgb radiance;

  double area() const;
  /// Distance at which a ray hits the light from either side; infinity: the ray misses.
  double intersect(const Ray& ray) const;
};

/// Spherical light in world space, mm.
struct PlacedSphere {
  Vec3 center;
  double radius;
  Rgb radiance;

  /// Distances > 0 at which a ray crosses the sphere: none, one (from inside) or two.
  std::vector<double> intersections(const Ray& ray) const;
};

class Lights {
public:
  Lights(const std::vector<Light>& lights, const Grid& volume, const View& view);

  /// Radiance of all environments and skies. `direction` points toward the environment.
  Rgb environment(const Vec3& direction) const;
  /// Radiance of all area lights that a ray hits on their emitting side before `end`, mm, and of
  /// all spheres that it hits; each sphere counts once.
  Rgb areaRadiance(const Ray& ray, double end) const;
  bool hasAreas() const { return m_areas.size() + m_spheres.size() > 0; }
  /// Direction from `point` to a uniform point on one of the area lights or spheres. areaPdf() is
  /// its pdf per steradian.
  Vec3 sampleArea(const Vec3& point, Generator& generator) const;
  double areaPdf(const Ray& ray) const;
  const std::vector<DirectionalLight>& directionals() const { return m_directionals; }

private:
  std::vector<EnvironmentLight> m_environments;
  std::vector<SkyLight> m_skies; ///< in world space
  std::vector<DirectionalLight> m_directionals;
  std::vector<PlacedArea> m_areas;
  std::vector<PlacedSphere> m_spheres;
};

} // namespace fenestra::core::oracle
