#include "model/medium/Scattering.h"

#include "model/medium/Reflectance.h"

namespace fenestra::core {
namespace {

/// Lower limit: directions in double cannot resolve a narrower lobe, and its density overflows.
constexpr double minRoughness = 1e-6;

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

scalar::Bsdf makeBsdf(double g, const std::optional<SurfaceShading>& shading) {
  if (!shading)
    return {g, 0.0, 0.0, 0.0, 1.0, 1.0, {}, false};
  const auto [lambert, glossy, f0, coat] = shading->lobes();
  const double roughness = std::max(minRoughness, std::sqrt(2.0 / (shading->power + 2.0)));
  return {g,
          lambert,
          glossy,
          f0,
          shading->oddsFactor,
          roughness,
          {coat.constant, coat.x2, coat.x4, coat.x8},
          shading->coated.has_value()};
}

ScatterSample Scattering::sample(double choice, const Vec2& u) const {
  const auto* const surface = std::get_if<scalar::SurfaceLobes>(&m_lobes);
  const scalar::ScatterSamples s =
      surface ? scalar::sampleLobe(*surface, choice, u.x(), u.y())
              : scalar::sampleLobe(std::get<scalar::PhaseLobe>(m_lobes), u.x(), u.y());
  return {toVector(s.outgoing), toColor(s.weight), s.pdf};
}

} // namespace fenestra::core
