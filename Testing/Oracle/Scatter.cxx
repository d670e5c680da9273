#include "Scatter.h"

namespace fenestra::oracle {
namespace {

/// Any unit vector across `direction`.
Vec3 across(const Vec3& direction) {
  const Vec3 axis = std::abs(direction.x()) < 0.6 ? Vec3::UnitX() : Vec3::UnitY();
  return direction.cross(axis).normalized();
}

/// The cosine about the direction of travel by inversion of Henyey and Greenstein's distribution.
Vec3 drawHenyeyGreenstein(const Vec3& incoming, double g, Generator& generator) {
  if (std::abs(g) < 1e-3)
    g = std::copysign(1e-3, g); // as near as the inversion does not cancel; density() knows
  const double inner = (1.0 - g * g) / (1.0 - g + 2.0 * g * uniform(generator));
  const double cosine = std::clamp((1.0 + g * g - inner * inner) / (2.0 * g), -1.0, 1.0);
  const double sine = std::sqrt(1.0 - cosine * cosine);
  const double phi = 2.0 * pi * uniform(generator);
  const Vec3 u = across(incoming);
  const Vec3 v = incoming.cross(u);
  return (cosine * incoming + sine * std::cos(phi) * u + sine * std::sin(phi) * v).normalized();
}

} // namespace

Vec3 uniformDirection(Generator& generator) {
  const double z = 2.0 * uniform(generator) - 1.0;
  const double phi = 2.0 * pi * uniform(generator);
  const double r = std::sqrt(1.0 - z * z);
  return {r * std::cos(phi), r * std::sin(phi), z};
}

double henyeyGreenstein(double cosine, double g) {
  return (1.0 - g * g) / (4.0 * pi * std::pow(1.0 + g * g - 2.0 * g * cosine, 1.5));
}

Scatterer Scatterer::byPhase(const Vec3& incoming, const Rgb& albedo, double g) {
  Scatterer scatterer;
  scatterer.m_incoming = incoming;
  scatterer.m_albedo = albedo;
  scatterer.m_g = g;
  return scatterer;
}

Scatterer Scatterer::atSurface(const Vec3& incoming, const Rgb& albedo, const Vec3& gradient,
                               const SurfaceShading& shading) {
  Scatterer scatterer = byPhase(incoming, albedo, 0.0);
  scatterer.m_shading = shading;
  scatterer.m_normal = -gradient.normalized();
  if (scatterer.m_normal.dot(incoming) > 0.0)
    scatterer.m_normal = -scatterer.m_normal;
  return scatterer;
}

/// At a surface, Lambert: albedo / pi; GGX (Walter et al. 2007): D F G / (4 cos_i cos_o), D of
/// roughness^2 = 2 / (power + 2), G the product of Smith's two terms, F Schlick's with F0 = 0.04.
Rgb Scatterer::f(const Vec3& outgoing) const {
  if (!m_shading)
    return m_albedo * henyeyGreenstein(m_incoming.dot(outgoing), m_g);
  const double cosIn = -m_incoming.dot(m_normal), cosOut = outgoing.dot(m_normal);
  if (cosOut <= 0.0 || cosIn <= 0.0)
    return Rgb::Zero();
  const double a2 = 2.0 / (m_shading->power + 2.0);
  const Vec3 h = (outgoing - m_incoming).normalized();
  const double cosHalf = h.dot(m_normal);
  const double d = a2 / (pi * std::pow(cosHalf * cosHalf * (a2 - 1.0) + 1.0, 2.0));
  const auto smith = [a2](double cosine) {
    return 2.0 / (1.0 + std::sqrt(1.0 + a2 * (1.0 / (cosine * cosine) - 1.0)));
  };
  const double fresnel = 0.04 + 0.96 * std::pow(1.0 - h.dot(outgoing), 5.0);
  const double glossy = d * fresnel * smith(cosIn) * smith(cosOut) / (4.0 * cosIn * cosOut);
  const double excess = std::max(1.0, m_shading->diffuse + m_shading->specular);
  return (m_shading->diffuse * m_albedo / pi + m_shading->specular * glossy) / excess * cosOut;
}

Vec3 Scatterer::draw(Generator& generator) const {
  if (!m_shading)
    return drawHenyeyGreenstein(m_incoming, m_g, generator);
  const Vec3 direction = uniformDirection(generator);
  return direction.dot(m_normal) < 0.0 ? Vec3(-direction) : direction;
}

double Scatterer::density(const Vec3& outgoing) const {
  if (m_shading)
    return outgoing.dot(m_normal) < 0.0 ? 0.0 : 0.5 / pi;
  const double g = std::abs(m_g) < 1e-3 ? std::copysign(1e-3, m_g) : m_g;
  return henyeyGreenstein(m_incoming.dot(outgoing), g);
}

} // namespace fenestra::oracle
