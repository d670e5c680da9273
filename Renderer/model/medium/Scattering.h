#pragma once
// Scattering at a real collision, in double. Conventions: `incoming` is the direction in which the
// path travels (away from the camera), `outgoing` the direction in which it continues (toward a
// light).

#include "base/ScalarMath.h"
#include "model/medium/TransferFunction.h"

#include <variant>

namespace fenestra::core::scalar {
#include "formulas/Scattering.inl"
} // namespace fenestra::core::scalar

namespace fenestra::core {

/// Without shading, the surface lobes reflect nothing.
scalar::Bsdf makeBsdf(double g, const std::optional<SurfaceShading>& shading);

struct ScatterSample {
  Vec3 outgoing;
  Rgb weight; ///< factor / pdf; zero ends the path
  double pdf; ///< per steradian
};

class Scattering {
public:
  /// By the phase function.
  Scattering(const Vec3& incoming, double g, const Rgb& albedo)
      : m_lobes(scalar::makePhaseLobe(g, incoming, albedo)) {}
  /// At a surface. `gradient` must not be zero. The normal is -gradient, turned to the side that
  /// the path comes from.
  Scattering(const Vec3& incoming, const Vec3& gradient, const SurfaceShading& shading,
             const Rgb& albedo)
      : m_lobes(scalar::makeSurfaceLobes(makeBsdf(0.0, shading), incoming, gradient, albedo)) {}

  bool isSurface() const { return std::holds_alternative<scalar::SurfaceLobes>(m_lobes); }
  /// Factor on radiance toward a direction, and the density of sample() there.
  scalar::ScatterEval evaluate(const Vec3& outgoing) const {
    return std::visit([&](const auto& lobes) { return scalar::evaluate(lobes, outgoing); },
                      m_lobes);
  }
  /// `choice`, in [0, 1), selects the lobe of a surface.
  ScatterSample sample(double choice, const Vec2& u) const;

private:
  std::variant<scalar::PhaseLobe, scalar::SurfaceLobes> m_lobes;
};

} // namespace fenestra::core
