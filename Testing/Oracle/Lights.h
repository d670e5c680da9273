#pragma once
// Light that a ray meets by itself, and the parallel light that it never can.

#include "Scatter.h"
#include "View.h"

namespace fenestra::oracle {

/// In the world, mm.
struct PlacedArea {
  AreaLight::Shape shape;
  Vec3 center, normal, right, up;
  Vec2 size; ///< full edges; the diameter twice
  Rgb radiance;

  double area() const;
  /// Where a ray meets it from either side, or infinity.
  double meeting(const Ray& ray) const;
};

class Lights {
public:
  Lights(const std::vector<Light>& lights, const Grid& volume, const View& view);

  /// Of all environments, from a direction of travel toward them.
  Rgb environment(const Vec3& direction) const;
  /// Of all area lights that a ray meets on their shining side before `end`, mm.
  Rgb areas(const Ray& ray, double end) const;
  bool hasAreas() const { return !m_areas.empty(); }
  /// Toward a uniform point of one of the area lights, and the density of that, per steradian.
  Vec3 towardArea(const Vec3& point, Generator& generator) const;
  double areaDensity(const Ray& ray) const;
  const std::vector<DirectionalLight>& directionals() const { return m_directionals; }

private:
  std::vector<EnvironmentLight> m_environments;
  std::vector<DirectionalLight> m_directionals;
  std::vector<PlacedArea> m_areas;
};

} // namespace fenestra::oracle
