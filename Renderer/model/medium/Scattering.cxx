#include "model/medium/Scattering.h"

#include "model/medium/Reflectance.h"

namespace fenestra::core {
namespace {

/// Lower limit: directions in double cannot resolve a narrower lobe, and its density overflows.
constexpr double minRoughness = 1e-6;

ScatterSample toSample(const scalar::ScatterSamples& sample) {
  return {toVector(sample.outgoing), toColor(sample.weight), sample.pdf};
}

} // namespace

// The power is the inverse of roughness^2 = 2 / (power + 2); 0.47: SurfaceShading::oddsFactor.
SurfaceShading SurfaceShading::makeCoated(double specular, double roughness, double g) {
  return {.diffuse = 1.0,
          .specular = specular,
          .power = 2.0 / (roughness * roughness) - 2.0,
          .coated = fitCoatReflectance(roughness),
          .oddsFactor = 0.47 * (1.0 - std::clamp(g, 0.0, maxReflectanceG))};
}

SurfaceShading::Lobes SurfaceShading::lobes() const {
  if (coated) {
    const CoatReflectance coat = coated->withScale(specular);
    return {diffuse / (1.0 - coat.mean()), specular, tissueF0, coat};
  }
  const double total = std::max(1.0, diffuse + specular);
  return {diffuse / total, specular / total, 0.04, {}}; // F0 of 0.04, no coat
}

BsdfParameters<double> makeBsdfParameters(double g, const std::optional<SurfaceShading>& shading) {
  BsdfParameters<double> bsdf{g, 0.0, 0.0, 0.0, 1.0, 1.0, false, {}};
  if (!shading)
    return bsdf;
  const auto [lambert, glossy, f0, coat] = shading->lobes();
  bsdf.diffuse = lambert;
  bsdf.specular = glossy;
  bsdf.f0 = f0;
  bsdf.oddsFactor = shading->oddsFactor;
  bsdf.roughness = std::max(minRoughness, std::sqrt(2.0 / (shading->power + 2.0)));
  bsdf.isCoated = shading->coated.has_value();
  bsdf.coat = {coat.constant, coat.x2, coat.x4, coat.x8};
  return bsdf;
}

Rgb PhaseScattering::evaluate(const Vec3& outgoing) const {
  return toColor(m_lobe.evaluate(outgoing).factor);
}

ScatterSample PhaseScattering::sample(const Vec2& u) const {
  return toSample(m_lobe.sample(u.x(), u.y()));
}

SurfaceScattering::SurfaceScattering(const Vec3& incoming, const Vec3& gradient,
                                     const SurfaceShading& shading, const Rgb& albedo)
    : m_lobes(makeBsdfParameters(0.0, shading), incoming, gradient, albedo) {}

double SurfaceScattering::pdf(const Vec3& outgoing) const {
  return m_lobes.evaluate(outgoing).pdf;
}

Rgb SurfaceScattering::evaluate(const Vec3& outgoing) const {
  return toColor(m_lobes.evaluate(outgoing).factor);
}

ScatterSample SurfaceScattering::sample(double choice, const Vec2& u) const {
  return toSample(m_lobes.sample(choice, u.x(), u.y()));
}

} // namespace fenestra::core
