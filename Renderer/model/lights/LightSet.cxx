#include "model/lights/LightSet.h"

namespace fenestra {
namespace {

/// Least share of a light, relative to an equal share: a light that is dark at the volume's centre
/// may matter elsewhere.
constexpr double leastShare = 0.05;

} // namespace

LightSet::LightSet(const std::vector<Light>& lights, const Grid& volume, const Camera& camera,
                   const Vec3& focus)
    : m_count(lights.size()) {
  const Mat3 cameraAxes(camera.right(), camera.up(), -camera.forward());
  const FrameInWorld frames[] = {// as in LightFrame
                                 {},
                                 {cameraAxes, volume.worldCenter(), volume.boundingRadius()},
                                 {Mat3::Identity(), focus, 1.0}};
  const auto placeKind = [&](const auto& light) {
    if constexpr (requires { light.frame; })
      place(light, frames[static_cast<std::size_t>(light.frame)]);
    else
      place(light);
  };
  for (const Light& light : lights)
    std::visit(placeKind, light);
  chooseShares(volume.worldCenter());
}

void LightSet::place(const EnvironmentLight& light) {
  m_environments.push_back({EnvironmentSampler(light), 0.0});
}

void LightSet::place(const DirectionalLight& light) {
  m_directionals.push_back({-light.direction.normalized(), light.irradiance, 0.0});
}

void LightSet::place(const SkyLight& light, const FrameInWorld& frame) {
  SkyLight sky = light;
  sky.up = (frame.axes * light.up).normalized();
  sky.frame = LightFrame::world;
  m_skies.push_back(sky);
}

void LightSet::place(const AreaLight& light, const FrameInWorld& frame) {
  PlacedAreaLight placed;
  placed.shape = light.shape;
  placed.center = frame.origin + frame.unit * (frame.axes * light.center);
  placed.normal = (frame.axes * light.normal).normalized();
  const Vec3 up = frame.axes * light.up;
  const Vec3 across = up.cross(placed.normal);
  placed.right =
      across.norm() > 1e-9 * up.norm() ? Vec3(across.normalized()) : Frame(placed.normal).tangent;
  placed.up = placed.normal.cross(placed.right);
  const bool disk = light.shape == AreaLight::Shape::disk;
  placed.half = 0.5 * frame.unit * (disk ? Vec2::Constant(light.size.x()) : light.size);
  placed.area = placed.half.prod() * (disk ? pi : 4.0);
  placed.radiance = light.radiance;
  placed.share = 0.0;
  m_areas.push_back(placed);
}

void LightSet::place(const SphereLight& light, const FrameInWorld& frame) {
  m_spheres.push_back({frame.origin + frame.unit * (frame.axes * light.center),
                       0.5 * frame.unit * light.diameter, light.radiance, 0.0});
}

/// Each light is drawn in proportion to its irradiance at the volume's centre.
void LightSet::chooseShares(const Vec3& center) {
  std::vector<double*> shares;
  for (SharedEnvironment& environment : m_environments) {
    if (!(environment.sampler.total() > 0.0)) // constant, or black: nothing to draw
      continue;
    environment.share = pi * brightness(environment.sampler.mean());
    shares.push_back(&environment.share);
  }
  for (PlacedDirectionalLight& light : m_directionals) {
    light.share = brightness(light.irradiance);
    shares.push_back(&light.share);
  }
  for (PlacedAreaLight& light : m_areas) {
    const Vec3 d = center - light.center;
    const double cosine = std::max(0.0, light.normal.dot(d.normalized()));
    light.share = brightness(light.radiance) * light.area * cosine / d.squaredNorm();
    shares.push_back(&light.share);
  }
  for (PlacedSphereLight& light : m_spheres) {
    const double sine = std::min(1.0, light.radius / (center - light.center).norm());
    light.share = pi * brightness(light.radiance) * sine * sine;
    shares.push_back(&light.share);
  }
  double sum = 0.0;
  for (const double* share : shares)
    sum += *share;
  if (!(sum > 0.0) || !std::isfinite(sum)) {
    for (double* share : shares)
      *share = 1.0 / static_cast<double>(shares.size());
    return;
  }
  const double floor = leastShare / static_cast<double>(shares.size());
  for (double* share : shares)
    *share = floor + (1.0 - leastShare) * *share / sum;
}

std::optional<LightSample> LightSet::sample(const Vec3& point, double choice, const Vec2& u) const {
  for (const PlacedAreaLight& light : m_areas) {
    if (choice < light.share)
      return light.sample(point, u);
    choice -= light.share;
  }
  for (const PlacedDirectionalLight& light : m_directionals) {
    if (choice < light.share)
      return LightSample{light.toward, infinity, light.irradiance, light.share, true};
    choice -= light.share;
  }
  for (const PlacedSphereLight& light : m_spheres) {
    if (choice < light.share)
      return light.sample(point, u);
    choice -= light.share;
  }
  return sampleEnvironment(choice, u);
}

std::optional<LightSample> LightSet::sampleEnvironment(double choice, const Vec2& u) const {
  const SharedEnvironment* chosen = nullptr;
  for (const SharedEnvironment& environment : m_environments) {
    if (environment.share == 0.0)
      continue;
    chosen = &environment; // the last map takes the remainder of rounding
    if (choice < environment.share)
      break;
    choice -= environment.share;
  }
  if (chosen == nullptr)
    return std::nullopt;
  const Vec3 direction = chosen->sampler.sample(u);
  const LightArrival arrival = environment(direction);
  if (!(arrival.pdf > 0.0))
    return std::nullopt;
  return LightSample{direction, infinity, arrival.radiance, arrival.pdf, false};
}

LightArrival LightSet::environment(const Vec3& direction) const {
  LightArrival sum;
  for (const SharedEnvironment& environment : m_environments) {
    sum.radiance += environment.sampler.radiance(direction);
    sum.pdf += environment.share * environment.sampler.pdf(direction);
  }
  for (const SkyLight& sky : m_skies)
    sum.radiance += sky.radiance(direction);
  return sum;
}

Rgb LightSet::constantEnvironment() const {
  Rgb sum = Rgb::Zero();
  for (const SharedEnvironment& environment : m_environments)
    if (environment.sampler.constant())
      sum += environment.sampler.mean();
  return sum;
}

bool LightSet::hasMaps() const {
  return std::ranges::any_of(m_environments, [](const auto& e) { return !e.sampler.constant(); });
}

std::optional<LightSample> PlacedAreaLight::sample(const Vec3& point, const Vec2& u) const {
  Vec2 at = 2.0 * u - Vec2::Ones();
  if (shape == AreaLight::Shape::disk) {
    const double phi = 2.0 * pi * u.y();
    at = std::sqrt(u.x()) * Vec2(std::cos(phi), std::sin(phi));
  }
  const Vec3 d = center + half.x() * at.x() * right + half.y() * at.y() * up - point;
  const double distance2 = d.squaredNorm();
  if (!(distance2 >= std::numeric_limits<double>::min()))
    return std::nullopt; // on the light: no direction
  const double distance = std::sqrt(distance2);
  const double cosine = -normal.dot(d) / distance;
  if (!(cosine > 0.0))
    return std::nullopt; // behind the light, or in its plane
  return LightSample{d / distance, distance, radiance, share * distance2 / (area * cosine), false};
}

std::optional<LightArrival> PlacedAreaLight::arrival(const Ray& ray, double end) const {
  const double cosine = -normal.dot(ray.direction);
  if (!(cosine > 0.0))
    return std::nullopt;
  const double t = normal.dot(ray.origin - center) / cosine;
  if (!(t > 0.0) || !(t < end))
    return std::nullopt;
  const Vec3 d = ray.at(t) - center;
  const Vec2 at(d.dot(right) / half.x(), d.dot(up) / half.y());
  const bool inside =
      shape == AreaLight::Shape::disk ? at.squaredNorm() <= 1.0 : at.cwiseAbs().maxCoeff() <= 1.0;
  if (!inside)
    return std::nullopt;
  return LightArrival{radiance, share * t * t / (area * cosine)};
}

/// 1 - cos of half the angle that the sphere subtends, as sin^2 / (1 + cos), which keeps the digits
/// of narrow cones; 2 from inside: all directions. The solid angle is 2 pi of that.
double PlacedSphereLight::spread(double distance2) const {
  const double sine2 = radius * radius / distance2;
  if (!(sine2 < 1.0)) // also at the centre of a sphere too small to have a square
    return 2.0;
  return sine2 / (1.0 + std::sqrt(1.0 - sine2));
}

/// Distance to the sphere of a ray from `point` toward a direction in which the centre is `along`
/// mm ahead, and aside by the square root of `across2`.
double PlacedSphereLight::toward(const Vec3& point, double along, double across2) const {
  const double radius2 = radius * radius;
  const double outside = (center - point).squaredNorm() - radius2;
  const double half = std::sqrt(std::max(0.0, radius2 - across2)); // of the chord
  return outside > 0.0 ? outside / (along + half) : along + half;
}

std::optional<LightSample> PlacedSphereLight::sample(const Vec3& point, const Vec2& u) const {
  const Vec3 d = center - point;
  const double distance2 = d.squaredNorm();
  const double distance = std::sqrt(distance2);
  const double cone = spread(distance2);
  const double fall = cone * u.x(); // 1 - cos of the angle to the axis
  const double sine2 = fall * (2.0 - fall);
  const double sine = std::sqrt(std::max(0.0, sine2));
  const double phi = 2.0 * pi * u.y();
  const Frame frame(distance > 0.0 ? Vec3(d / distance) : Vec3(Vec3::UnitZ()));
  const Vec3 direction =
      frame.toWorld({sine * std::cos(phi), sine * std::sin(phi), 1.0 - fall}).normalized();
  return LightSample{direction, toward(point, distance * (1.0 - fall), distance2 * sine2), radiance,
                     share / (2.0 * pi * cone), false};
}

std::optional<LightArrival> PlacedSphereLight::arrival(const Ray& ray, double end) const {
  const Vec3 d = center - ray.origin;
  const double distance2 = d.squaredNorm();
  const double along = d.dot(ray.direction);
  const double across2 = (d - along * ray.direction).squaredNorm();
  const double radius2 = radius * radius;
  if (distance2 > radius2 && !(along > 0.0 && across2 <= radius2))
    return std::nullopt;
  if (!(toward(ray.origin, along, across2) < end))
    return std::nullopt;
  return LightArrival{radiance, share / (2.0 * pi * spread(distance2))};
}

} // namespace fenestra
