#pragma once
// Scattering at a real collision, by the phase function or at a surface. Conventions: `incoming` is
// the direction in which the path travels (away from the camera), `outgoing` the direction in which
// it continues (toward a light). evaluate() is the factor on radiance per steradian, including the
// albedo and, at surfaces, the cosine; pdf() is per steradian.

#include "base/Random.h"
#include "base/ScalarMath.h"
#include "model/medium/BsdfParameters.h"

#include <variant>

namespace fenestra::core::scalar {
#include "model/medium/ScatteringFormulas-inl.h"
} // namespace fenestra::core::scalar

namespace fenestra::core {

struct ScatterSample {
  Vec3 outgoing;
  Rgb weight; ///< evaluate / pdf; zero ends the path
  double pdf;
};

/// The phase function.
class PhaseScattering {
public:
  PhaseScattering(const Vec3& incoming, double g, const Rgb& albedo)
      : m_lobe(g, incoming, albedo) {}

  double pdf(const Vec3& outgoing) const { return m_lobe.evaluate(outgoing).pdf; }
  Rgb evaluate(const Vec3& outgoing) const;
  ScatterSample sample(const Vec2& u) const;

private:
  scalar::PhaseLobe<double> m_lobe;
};

/// Lambert and GGX lobes of a surface.
class SurfaceScattering {
public:
  /// `gradient` must not be zero. The normal is -gradient, turned to the side that the path comes
  /// from.
  SurfaceScattering(const Vec3& incoming, const Vec3& gradient, const SurfaceShading& shading,
                    const Rgb& albedo);

  double pdf(const Vec3& outgoing) const;
  Rgb evaluate(const Vec3& outgoing) const;
  /// `choice`, in [0, 1), selects the lobe.
  ScatterSample sample(double choice, const Vec2& u) const;

private:
  scalar::SurfaceLobes<double> m_lobes;
};

using Scattering = std::variant<PhaseScattering, SurfaceScattering>;

inline double scatteringPdf(const Scattering& s, const Vec3& outgoing) {
  return std::visit([&](const auto& kind) { return kind.pdf(outgoing); }, s);
}
inline Rgb evaluateScattering(const Scattering& s, const Vec3& outgoing) {
  return std::visit([&](const auto& kind) { return kind.evaluate(outgoing); }, s);
}
/// `u` samples the direction, `random` the lobe.
inline ScatterSample sampleScattering(const Scattering& s, const Vec2& u, Random& random) {
  if (const auto* surface = std::get_if<SurfaceScattering>(&s))
    return surface->sample(random.uniform(), u);
  return std::get<PhaseScattering>(s).sample(u);
}

} // namespace fenestra::core
