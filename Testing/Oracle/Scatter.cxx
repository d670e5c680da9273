#include "Scatter.h"

namespace fenestra::core::oracle {
namespace {

/// Some unit vector perpendicular to `direction`.
Vec3 findPerpendicular(const Vec3& direction) {
  const Vec3 axis = std::abs(direction.x()) < 0.6 ? Vec3::UnitX() : Vec3::UnitY();
  return direction.cross(axis).normalized();
}

/// Random unit vector at a given cosine to a direction.
Vec3 sampleCone(const Vec3& direction, double cosine, Generator& generator) {
  const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
  const double phi = 2.0 * pi * uniform(generator);
  const Vec3 u = findPerpendicular(direction);
  const Vec3 v = direction.cross(u);
  return (cosine * direction + sine * std::cos(phi) * u + sine * std::sin(phi) * v).normalized();
}

/// Near g = 0 the inversion below suffers from cancellation. Using g = 0 instead is unbiased, since
/// pdf() uses the same value.
double avoidCancellation(double g) {
  return std::abs(g) < 1e-3 ? 0.0 : g;
}

/// Samples a direction by inversion of Henyey and Greenstein's distribution of the cosine.
Vec3 sampleHenyeyGreenstein(const Vec3& incoming, double g, Generator& generator) {
  const double u = uniform(generator);
  if (g == 0.0)
    return sampleCone(incoming, 2.0 * u - 1.0, generator);
  const double inner = (1.0 - g * g) / (1.0 - g + 2.0 * g * u);
  const double cosine = std::clamp((1.0 + g * g - inner * inner) / (2.0 * g), -1.0, 1.0);
  return sampleCone(incoming, cosine, generator);
}

/// GGX roughness squared, from a Blinn-Phong exponent.
double roughness2(const SurfaceShading& shading) {
  return 2.0 / (shading.power + 2.0);
}

double evaluateCoat(const CoatReflectance& coat, double cosine) {
  const double x = 1.0 - cosine;
  return coat.constant + coat.x2 * std::pow(x, 2) + coat.x4 * std::pow(x, 4) +
         coat.x8 * std::pow(x, 8);
}

} // namespace

double henyeyGreenstein(double cosine, double g) {
  return (1.0 - g * g) / (4.0 * pi * std::pow(1.0 + g * g - 2.0 * g * cosine, 1.5));
}

Scatterer Scatterer::makePhase(const Vec3& incoming, const Rgb& albedo, double g) {
  Scatterer scatterer;
  scatterer.m_incoming = incoming;
  scatterer.m_albedo = albedo;
  scatterer.m_g = g;
  return scatterer;
}

Scatterer Scatterer::makeSurface(const Vec3& incoming, const Rgb& albedo, const Vec3& gradient,
                                 const SurfaceShading& shading) {
  Scatterer scatterer = makePhase(incoming, albedo, 0.0);
  scatterer.m_shading = shading;
  scatterer.m_normal = -gradient.normalized();
  if (scatterer.m_normal.dot(incoming) > 0.0)
    scatterer.m_normal = -scatterer.m_normal;
  return scatterer;
}

/// At a surface, Lambert: albedo / pi; GGX (Walter et al. 2007): D F G / (4 cos_i cos_o), D of
/// roughness^2 = 2 / (power + 2), G the product of Smith's two terms, F Schlick's with F0 = 0.04.
/// Coat of weight w, F0 = 0.028, over a matte base (Kelemen, Szirmay-Kalos 2001):
/// base / pi (1 - w E(cos_i)) (1 - w E(cos_o)) / (1 - w E_mean). E is the coat's total reflectance,
/// E_mean the integral of 2 x E(x); base / (1 - base) = oddsFactor albedo / (1 - albedo).
Rgb Scatterer::f(const Vec3& outgoing) const {
  if (!m_shading)
    return m_albedo * henyeyGreenstein(m_incoming.dot(outgoing), m_g);
  const double cosIn = -m_incoming.dot(m_normal), cosOut = outgoing.dot(m_normal);
  if (cosOut <= 0.0 || cosIn <= 0.0)
    return Rgb::Zero();
  const double a2 = roughness2(*m_shading);
  const Vec3 h = (outgoing - m_incoming).normalized();
  const double d = facetPdf(h);
  const auto smith = [a2](double cosine) {
    return 2.0 / (1.0 + std::sqrt(1.0 + a2 * (1.0 / (cosine * cosine) - 1.0)));
  };
  const double f0 = m_shading->coated ? 0.028 : 0.04;
  const auto fresnel = [f0](double cosine) {
    return f0 + (1.0 - f0) * std::pow(1.0 - cosine, 5.0);
  };
  const double glossy =
      d * fresnel(h.dot(outgoing)) * smith(cosIn) * smith(cosOut) / (4.0 * cosIn * cosOut);
  const double w = m_shading->specular;
  if (m_shading->coated) {
    const auto transmittance = [&](double cosine) {
      return 1.0 - w * evaluateCoat(*m_shading->coated, cosine);
    };
    const double twoWay = transmittance(cosIn) * transmittance(cosOut);
    double integral = 0.0; // of 2 x transmittance(x), by the midpoint rule
    constexpr int steps = 64;
    for (int i = 0; i < steps; ++i)
      integral += 2.0 * (i + 0.5) / steps * transmittance((i + 0.5) / steps) / steps;
    Rgb base = m_albedo;
    for (int c = 0; c < 3; ++c)
      if (base[c] > 0.0)
        base[c] = 1.0 / (1.0 + (1.0 / m_albedo[c] - 1.0) / m_shading->oddsFactor);
    return (m_shading->diffuse * base / pi * twoWay / integral + w * glossy) * cosOut;
  }
  const double excess = std::max(1.0, m_shading->diffuse + m_shading->specular);
  return (m_shading->diffuse * m_albedo / pi + w * glossy) / excess * cosOut;
}

double Scatterer::facetPdf(const Vec3& h) const {
  const double a2 = roughness2(*m_shading);
  return a2 / (pi * std::pow(std::pow(h.dot(m_normal), 2.0) * (a2 - 1.0) + 1.0, 2.0));
}

Vec3 Scatterer::sample(Generator& generator) const {
  if (!m_shading)
    return sampleHenyeyGreenstein(m_incoming, avoidCancellation(m_g), generator);
  const double u = uniform(generator);
  if (uniform(generator) < 0.5)
    return sampleCone(m_normal, std::sqrt(u), generator);
  const double cosine = std::sqrt((1.0 - u) / (1.0 + (roughness2(*m_shading) - 1.0) * u));
  const Vec3 h = sampleCone(m_normal, cosine, generator);
  return m_incoming - 2.0 * m_incoming.dot(h) * h;
}

double Scatterer::pdf(const Vec3& outgoing) const {
  if (!m_shading)
    return henyeyGreenstein(m_incoming.dot(outgoing), avoidCancellation(m_g));
  const double lambert = std::max(0.0, outgoing.dot(m_normal)) / pi;
  Vec3 h = (outgoing - m_incoming).normalized();
  if (h.dot(m_normal) < 0.0)
    h = -h;
  const double glossy = facetPdf(h) * h.dot(m_normal) / (4.0 * std::abs(outgoing.dot(h)));
  return 0.5 * lambert + 0.5 * glossy;
}

} // namespace fenestra::core::oracle
