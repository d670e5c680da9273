#include "model/medium/Scattering.h"

#include "model/medium/Reflectance.h"

namespace fenestra {
namespace {

/// Roughness limit: a narrower lobe is finer than directions in double, and its density overflows.
constexpr double leastRoughness = 1e-6;

Vec3 cosineHemisphere(const Vec2& u) {
  const double r = std::sqrt(u.x());
  const double phi = 2.0 * pi * u.y();
  return {r * std::cos(phi), r * std::sin(phi), std::sqrt(1.0 - u.x())};
}

} // namespace

SurfaceShading SurfaceShading::coat(double specular, double roughness, double g) {
  return {.diffuse = 1.0,
          .specular = specular,
          .power = 2.0 / (roughness * roughness) - 2.0,
          .coated = coatReflectance(roughness),
          .odds = 0.47 * (1.0 - std::clamp(g, 0.0, greatestColorG))};
}

SurfaceShading::Lobes SurfaceShading::lobes() const {
  if (coated) {
    const CoatReflectance coat = coated->scaled(specular);
    return {diffuse / (1.0 - coat.mean()), specular, tissueF0, coat};
  }
  const double total = std::max(1.0, diffuse + specular);
  return {diffuse / total, specular / total, 0.04, {}};
}

double PhaseScattering::pdf(const Vec3& outgoing) const {
  if (m_g == 0.0)
    return 0.25 / pi;
  // 1 + g^2 - 2 g cos, written so that nothing cancels where g and cos are near 1: with unit
  // vectors 2 (1 - cos) = |a - b|^2.
  const double chord2 = (outgoing - m_peak).squaredNorm();
  const double d = (1.0 - m_g) * (1.0 - m_g) + m_g * chord2;
  return 0.25 / pi * (1.0 - m_g) * (1.0 + m_g) / (d * std::sqrt(d));
}

ScatterSample PhaseScattering::sample(const Vec2& u) const {
  if (m_g == 0.0)
    return {uniformDirection(u), m_albedo, 0.25 / pi};
  // cos = (1 + g^2 - ((1 - g^2) / (1 + g - 2 g u))^2) / (2 g), as 1 - cos for accuracy near 1:
  // with a = 1 + g - 2 g u, 1 - cos = 2 u (1 - g)^2 (1 + g (1 - u)) / a^2.
  const double a = 1.0 + m_g - 2.0 * m_g * u.x();
  const double oneMinusCos =
      2.0 * u.x() * (1.0 - m_g) * (1.0 - m_g) * (1.0 + m_g * (1.0 - u.x())) / (a * a);
  const double cosine = std::clamp(1.0 - oneMinusCos, -1.0, 1.0);
  const double sine = std::sqrt(std::max(0.0, std::min(oneMinusCos, 2.0) * (1.0 + cosine)));
  const double phi = 2.0 * pi * u.y();
  const Frame frame(m_peak);
  const Vec3 outgoing =
      frame.toWorld({sine * std::cos(phi), sine * std::sin(phi), cosine}).normalized();
  return {outgoing, m_albedo, pdf(outgoing)};
}

SurfaceScattering::SurfaceScattering(const Vec3& incoming, const Vec3& gradient,
                                     const SurfaceShading& shading, const Rgb& albedo)
    : m_frame((incoming.dot(gradient) >= 0.0 ? -gradient : gradient).normalized()),
      m_viewer(m_frame.toLocal(-incoming)) {
  const SurfaceShading::Lobes lobes = shading.lobes();
  m_specular = lobes.glossy;
  m_f0 = lobes.f0;
  m_coat = lobes.coat;
  m_diffuse = lobes.lambert * (shading.odds * albedo / (1.0 - (1.0 - shading.odds) * albedo));
  m_isCoated = shading.coated.has_value();
  if (m_isCoated)
    m_diffuse *= belowCoat(m_viewer.z());
  m_roughness = std::max(leastRoughness, std::sqrt(2.0 / (shading.power + 2.0)));
  const double lambert = m_diffuse.maxCoeff();
  const double glossy = m_specular * fresnel(m_viewer.z());
  m_lambertShare = lambert + glossy > 0.0 ? lambert / (lambert + glossy) : 1.0;
}

/// Schlick 1994.
double SurfaceScattering::fresnel(double cosine) const {
  return m_f0 + (1.0 - m_f0) * std::pow(std::clamp(1.0 - cosine, 0.0, 1.0), 5.0);
}

double SurfaceScattering::masking(const Vec3& v) const {
  const double a2 = m_roughness * m_roughness;
  const double sine2 = v.x() * v.x() + v.y() * v.y();
  const double cosine = std::abs(v.z());
  return 2.0 * cosine / (cosine + std::sqrt(cosine * cosine + a2 * sine2));
}

double SurfaceScattering::normalDensity(const Vec3& h) const {
  const double a2 = m_roughness * m_roughness;
  const double d = h.x() * h.x() + h.y() * h.y() + a2 * h.z() * h.z();
  return a2 / (pi * d * d);
}

double SurfaceScattering::glossyPdf(const Vec3& l) const {
  if (l.z() <= 0.0 || m_viewer.z() <= 0.0)
    return 0.0;
  const Vec3 h = (l + m_viewer).normalized();
  return masking(m_viewer) * normalDensity(h) / (4.0 * m_viewer.z()); // Heitz 2018, eq. 17
}

double SurfaceScattering::pdf(const Vec3& outgoing) const {
  const Vec3 l = m_frame.toLocal(outgoing);
  return m_lambertShare * lambertPdf(l) + (1.0 - m_lambertShare) * glossyPdf(l);
}

Rgb SurfaceScattering::evaluate(const Vec3& outgoing) const {
  const Vec3 l = m_frame.toLocal(outgoing);
  if (l.z() <= 0.0)
    return Rgb::Zero();
  Rgb value = m_diffuse * lambertPdf(l);
  if (m_isCoated)
    value *= belowCoat(l.z());
  if (m_specular > 0.0 && m_viewer.z() > 0.0) {
    // D F G / (4 cos cos) times the outgoing cosine, G separable (Smith).
    const Vec3 h = (l + m_viewer).normalized();
    value += m_specular * fresnel(l.dot(h)) * normalDensity(h) * masking(l) * masking(m_viewer) /
             (4.0 * m_viewer.z());
  }
  return value;
}

/// Heitz 2018, listing 1.
Vec3 SurfaceScattering::sampleVisibleNormal(const Vec2& u) const {
  const double a = m_roughness;
  const Vec3 stretched = Vec3(a * m_viewer.x(), a * m_viewer.y(), m_viewer.z()).normalized();
  const double r = std::sqrt(u.x());
  const double phi = 2.0 * pi * u.y();
  const double p1 = r * std::cos(phi);
  const double s = 0.5 * (1.0 + stretched.z());
  const Vec3 side = stretched.z() < 1.0 && stretched.head<2>().squaredNorm() > 0.0
                        ? Vec3(-stretched.y(), stretched.x(), 0.0).normalized()
                        : Vec3(Vec3::UnitX());
  const Vec3 other = stretched.cross(side);
  const double p2 = (1.0 - s) * std::sqrt(std::max(0.0, 1.0 - p1 * p1)) + s * r * std::sin(phi);
  const Vec3 n =
      p1 * side + p2 * other + std::sqrt(std::max(0.0, 1.0 - p1 * p1 - p2 * p2)) * stretched;
  return Vec3(a * n.x(), a * n.y(), std::max(1e-300, n.z())).normalized();
}

ScatterSample SurfaceScattering::sample(double choice, const Vec2& u) const {
  Vec3 l;
  if (choice < m_lambertShare) {
    l = cosineHemisphere(u);
  } else {
    const Vec3 h = sampleVisibleNormal(u);
    l = 2.0 * m_viewer.dot(h) * h - m_viewer;
  }
  const Vec3 outgoing = m_frame.toWorld(l).normalized();
  const double density = pdf(outgoing);
  if (!(density > 0.0))
    return {outgoing, Rgb::Zero(), 0.0};
  return {outgoing, evaluate(outgoing) / density, density};
}

} // namespace fenestra
