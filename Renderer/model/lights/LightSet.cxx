#include "model/lights/LightSet.h"

namespace fenestra::core {
namespace {

/// Lower bound of a light's pmf, relative to uniform selection: a light that is dark at the
/// volume's center may be bright elsewhere.
constexpr double minPmf = 0.05;

// Irradiance at a point, of a surface that faces the light.
using Tables = LightTables<double>;
double estimateIrradiance(const Tables::PlacedDirectional& light, const Vec3&) {
  return brightness(light.irradiance);
}
double estimateIrradiance(const Tables::PlacedArea& light, const Vec3& point) {
  const Vec3 d = point - light.center;
  const double cosine = std::max(0.0, light.normal.dot(d.normalized()));
  return brightness(light.radiance) * light.area * cosine / d.squaredNorm();
}
double estimateIrradiance(const Tables::PlacedSphere& light, const Vec3& point) {
  const double sine2 = std::min(1.0, light.radius2 / (point - light.center).squaredNorm());
  return pi * brightness(light.radiance) * sine2;
}

} // namespace

LightSet::LightSet(const std::vector<Light>& lights, const Grid& volume, const Camera& camera,
                   const Vec3& focus) {
  const Mat3 cameraAxes(camera.right(), camera.up(), -camera.forward());
  const WorldFrame frames[] = {// in the order of LightFrame
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
  computePmfs(volume.worldCenter());
}

void LightSet::place(const EnvironmentLight& light) {
  m_environments.push_back({EnvironmentSampler(light), 0.0});
  if (m_environments.back().sampler.isConstant())
    m_tables.constant += light.radiance;
}

void LightSet::place(const DirectionalLight& light) {
  m_tables.directionals.push_back({-light.direction.normalized(), light.irradiance, 0.0});
}

void LightSet::place(const SkyLight& light, const WorldFrame& frame) {
  m_tables.skies.push_back({(frame.axes * light.up).normalized(), light.middle,
                            light.top - light.middle, light.bottom - light.middle});
}

void LightSet::place(const AreaLight& light, const WorldFrame& frame) {
  const bool isDisk = light.shape == AreaLight::Shape::disk;
  const Vec3 center = frame.origin + frame.unit * (frame.axes * light.center);
  const Vec3 normal = (frame.axes * light.normal).normalized();
  const Vec3 lightUp = frame.axes * light.up;
  const Vec3 across = lightUp.cross(normal);
  const Vec3 side =
      across.norm() > 1e-9 * lightUp.norm() ? Vec3(across.normalized()) : Frame(normal).tangent;
  const Vec2 half = 0.5 * frame.unit * (isDisk ? Vec2::Constant(light.size.x()) : light.size);
  const Vec3 right = half.x() * side, up = half.y() * normal.cross(side);
  m_tables.areas.push_back({isDisk, center, normal, right, up, 1.0 / right.squaredNorm(),
                            1.0 / up.squaredNorm(), half.prod() * (isDisk ? pi : 4.0),
                            light.radiance, 0.0});
}

void LightSet::place(const SphereLight& light, const WorldFrame& frame) {
  const double radius = 0.5 * frame.unit * light.diameter;
  m_tables.spheres.push_back({frame.origin + frame.unit * (frame.axes * light.center),
                              radius * radius, light.radiance, 0.0});
}

/// Selects lights in proportion to their irradiance at the volume's center.
void LightSet::computePmfs(const Vec3& center) {
  std::vector<double*> pmfs;
  for (PlacedEnvironment& environment : m_environments) {
    if (!(environment.sampler.integral() > 0.0)) // constant, or black: never sampled
      continue;
    environment.pmf = pi * brightness(environment.sampler.mean());
    pmfs.push_back(&environment.pmf);
  }
  Tables::forEachSampled(m_tables, [&](auto& list) {
    for (auto& light : list) {
      light.pmf = estimateIrradiance(light, center);
      pmfs.push_back(&light.pmf);
    }
  });
  double sum = 0.0;
  for (const double* pmf : pmfs)
    sum += *pmf;
  if (!(sum > 0.0) || !std::isfinite(sum)) {
    for (double* pmf : pmfs)
      *pmf = 1.0 / static_cast<double>(pmfs.size());
    return;
  }
  const double floor = minPmf / static_cast<double>(pmfs.size());
  for (double* pmf : pmfs)
    *pmf = floor + (1.0 - minPmf) * *pmf / sum;
}

std::optional<LightSample> LightSet::sample(const Vec3& point, double choice, const Vec2& u) const {
  scalar::LaneMask unsampled = true;
  const scalar::LightSamples lightSample =
      scalar::sampleLights(m_tables, unsampled, point, choice, u.x(), u.y());
  if (unsampled)
    return sampleEnvironment(choice, u);
  const Rgb radiance = toColor(lightSample.radiance);
  if (!(radiance.maxCoeff() > 0.0))
    return std::nullopt;
  return LightSample{toVector(lightSample.direction), lightSample.distance, radiance,
                     lightSample.pdf, lightSample.isDelta};
}

std::optional<LightSample> LightSet::sampleEnvironment(double choice, const Vec2& u) const {
  const PlacedEnvironment* chosen = nullptr;
  for (const PlacedEnvironment& environment : m_environments) {
    if (environment.pmf == 0.0)
      continue;
    chosen = &environment; // rounding: the last map takes the remainder
    if (choice < environment.pmf)
      break;
    choice -= environment.pmf;
  }
  if (chosen == nullptr)
    return std::nullopt;
  const Vec3 direction = chosen->sampler.sample(u);
  const EmitterHit hit = evaluateEnvironment(direction);
  if (!(hit.pdf > 0.0))
    return std::nullopt;
  return LightSample{direction, infinity, hit.radiance, hit.pdf, false};
}

EmitterHit LightSet::evaluateEnvironment(const Vec3& direction) const {
  EmitterHit sum{toColor(scalar::evaluateSkies(m_tables, direction)), 0.0};
  for (const PlacedEnvironment& environment : m_environments) {
    if (environment.sampler.isConstant())
      continue;
    sum.radiance += environment.sampler.radiance(direction);
    sum.pdf += environment.pmf * environment.sampler.pdf(direction);
  }
  return sum;
}

bool LightSet::hasMaps() const {
  return std::ranges::any_of(m_environments, [](const auto& e) { return !e.sampler.isConstant(); });
}

} // namespace fenestra::core
