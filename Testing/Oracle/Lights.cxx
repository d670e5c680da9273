#include "Lights.h"

namespace fenestra::core::oracle {
namespace {

/// Maximum distance of a corner of the volume's box from its center, mm.
double boundingRadius(const Grid& grid, const Vec3& center) {
  double radius = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    Vec3 index = Vec3::Constant(-0.5);
    for (int axis = 0; axis < 3; ++axis)
      if (corner >> axis & 1)
        index[axis] += static_cast<double>(grid.size[axis]);
    radius = std::max(radius, (grid.indexToWorld * index - center).norm());
  }
  return radius;
}

/// Bounding sphere of the volume: origin and unit of the camera's light frame.
struct BoundingSphere {
  Vec3 center;
  double radius;

  explicit BoundingSphere(const Grid& grid)
      : center(grid.indexToWorld * Vec3(0.5 * (grid.size.cast<double>() - Vec3::Ones()))),
        radius(boundingRadius(grid, center)) {}
};

PlacedArea place(const AreaLight& light, const Grid& grid, const View& view) {
  PlacedArea area{light.shape, light.center, light.normal,  {},
                  light.up,    light.size,   light.radiance};
  if (light.shape == AreaLight::Shape::disk)
    area.size.y() = area.size.x();
  if (light.frame == LightFrame::camera) {
    const auto [middle, radius] = BoundingSphere(grid);
    const auto toWorld = [&](const Vec3& v) {
      return Vec3(v.x() * view.right + v.y() * view.up - v.z() * view.forward);
    };
    area.center = middle + radius * toWorld(light.center);
    area.normal = toWorld(light.normal);
    area.up = toWorld(light.up);
    area.size *= radius;
  }
  area.normal = area.normal.normalized();
  area.up = (area.up - area.up.dot(area.normal) * area.normal).normalized();
  area.right = area.up.cross(area.normal);
  return area;
}

PlacedSphere place(const SphereLight& light, const Grid& grid, const View& view) {
  if (light.frame == LightFrame::world)
    return {light.center, 0.5 * light.diameter, light.radiance};
  const auto [middle, radius] = BoundingSphere(grid);
  const Vec3 from =
      light.center.x() * view.right + light.center.y() * view.up - light.center.z() * view.forward;
  return {middle + radius * from, 0.5 * radius * light.diameter, light.radiance};
}

/// Uniform point on the unit sphere, by rejection.
Vec3 sampleUnitSphere(Generator& generator) {
  for (;;) {
    const Vec3 p(2.0 * uniform(generator) - 1.0, 2.0 * uniform(generator) - 1.0,
                 2.0 * uniform(generator) - 1.0);
    if (p.norm() > 0.1 && p.norm() <= 1.0)
      return p.normalized();
  }
}

Rgb evaluate(const EnvironmentLight& light, const Vec3& direction) {
  const EnvironmentMap& map = light.map;
  if (map.width == 0)
    return light.radiance;
  const double u = 0.5 + std::atan2(direction.x(), direction.y()) / (2.0 * pi);
  const double v = std::acos(std::clamp(direction.z(), -1.0, 1.0)) / pi;
  const int column = std::clamp(static_cast<int>(std::floor(u * map.width)), 0, map.width - 1);
  const int row = std::clamp(static_cast<int>(std::floor(v * map.height)), 0, map.height - 1);
  const float* rgb = &map.rgb[3 * static_cast<std::size_t>(row * map.width + column)];
  return light.radiance * Rgb(rgb[0], rgb[1], rgb[2]);
}

/// A sky with its up direction in world space.
SkyLight place(const SkyLight& light, const View& view) {
  SkyLight sky = light;
  if (light.frame == LightFrame::camera)
    sky.up = light.up.x() * view.right + light.up.y() * view.up - light.up.z() * view.forward;
  return sky;
}

Rgb evaluate(const SkyLight& sky, const Vec3& direction) {
  const double height = direction.normalized().dot(sky.up.normalized());
  if (height >= 0.0)
    return (1.0 - height) * sky.middle + height * sky.top;
  return (1.0 + height) * sky.middle - height * sky.bottom;
}

} // namespace

Lights::Lights(const std::vector<Light>& lights, const Grid& volume, const View& view) {
  for (const Light& light : lights) {
    if (const auto* environment = std::get_if<EnvironmentLight>(&light))
      m_environments.push_back(*environment);
    else if (const auto* sky = std::get_if<SkyLight>(&light))
      m_skies.push_back(place(*sky, view));
    else if (const auto* directional = std::get_if<DirectionalLight>(&light))
      m_directionals.push_back(*directional);
    else if (const auto* sphere = std::get_if<SphereLight>(&light))
      m_spheres.push_back(place(*sphere, volume, view));
    else
      m_areas.push_back(place(std::get<AreaLight>(light), volume, view));
  }
}

Rgb Lights::environment(const Vec3& direction) const {
  Rgb sum = Rgb::Zero();
  for (const EnvironmentLight& light : m_environments)
    sum += evaluate(light, direction);
  for (const SkyLight& sky : m_skies)
    sum += evaluate(sky, direction);
  return sum;
}

double PlacedArea::area() const {
  return size.prod() * (shape == AreaLight::Shape::disk ? pi / 4.0 : 1.0);
}

double PlacedArea::intersect(const Ray& ray) const {
  const double slope = ray.direction.dot(normal);
  const double t = slope == 0.0 ? -1.0 : (center - ray.origin).dot(normal) / slope;
  if (t <= 0.0)
    return infinity;
  const Vec3 from = ray.at(t) - center;
  const double x = std::abs(from.dot(right)), y = std::abs(from.dot(up));
  const bool isOn = shape == AreaLight::Shape::disk ? std::hypot(x, y) <= 0.5 * size.x()
                                                    : x <= 0.5 * size.x() && y <= 0.5 * size.y();
  return isOn ? t : infinity;
}

std::vector<double> PlacedSphere::intersections(const Ray& ray) const {
  const Vec3 from = ray.origin - center;
  const double b = from.dot(ray.direction);
  const double discriminant = b * b - from.squaredNorm() + radius * radius;
  std::vector<double> ahead;
  if (discriminant >= 0.0)
    for (const double t : {-b - std::sqrt(discriminant), -b + std::sqrt(discriminant)})
      if (t > 0.0)
        ahead.push_back(t);
  return ahead;
}

Rgb Lights::areaRadiance(const Ray& ray, double end) const {
  Rgb sum = Rgb::Zero();
  for (const PlacedArea& light : m_areas)
    if (ray.direction.dot(light.normal) < 0.0 && light.intersect(ray) < end)
      sum += light.radiance;
  for (const PlacedSphere& sphere : m_spheres) {
    const std::vector<double> hits = sphere.intersections(ray);
    if (!hits.empty() && hits.front() < end)
      sum += sphere.radiance;
  }
  return sum;
}

Vec3 Lights::sampleArea(const Vec3& point, Generator& generator) const {
  const std::size_t index = generator() % (m_areas.size() + m_spheres.size());
  if (index >= m_areas.size()) {
    const PlacedSphere& sphere = m_spheres[index - m_areas.size()];
    return (sphere.center + sphere.radius * sampleUnitSphere(generator) - point).normalized();
  }
  const PlacedArea& light = m_areas[index];
  for (;;) {
    const double x = uniform(generator) - 0.5, y = uniform(generator) - 0.5;
    if (light.shape == AreaLight::Shape::disk && std::hypot(x, y) > 0.5)
      continue;
    const Vec3 p = light.center + x * light.size.x() * light.right + y * light.size.y() * light.up;
    return (p - point).normalized();
  }
}

double Lights::areaPdf(const Ray& ray) const {
  double sum = 0.0;
  for (const PlacedArea& light : m_areas) {
    const double t = light.intersect(ray);
    if (t < infinity)
      sum += t * t / (light.area() * std::abs(ray.direction.dot(light.normal)));
  }
  for (const PlacedSphere& sphere : m_spheres)
    for (const double t : sphere.intersections(ray)) {
      const Vec3 normal = (ray.at(t) - sphere.center) / sphere.radius;
      sum +=
          t * t / (4.0 * pi * sphere.radius * sphere.radius * std::abs(ray.direction.dot(normal)));
    }
  return sum / static_cast<double>(m_areas.size() + m_spheres.size());
}

} // namespace fenestra::core::oracle
