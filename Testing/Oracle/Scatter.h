#pragma once
// Scattering at a collision.

#include "OracleScene.h"

#include <random>

namespace fenestra::core::oracle {

using Generator = std::mt19937_64;

/// Uniform in [0, 1).
inline double uniform(Generator& generator) {
  return static_cast<double>(generator() >> 11) * 0x1p-53;
}

/// Henyey and Greenstein 1941, per steradian; `cosine`: between the directions of travel.
double henyeyGreenstein(double cosine, double g);

/// Collision that scatters by the phase function, or at a surface (gradient not zero). f: factor on
/// radiance per steradian, including albedo and, at surfaces, the cosine.
class Scatterer {
public:
  static Scatterer makePhase(const Vec3& incoming, const Rgb& albedo, double g);
  static Scatterer makeSurface(const Vec3& incoming, const Rgb& albedo, const Vec3& gradient,
                               const SurfaceShading& shading);

  Rgb f(const Vec3& outgoing) const;
  /// Samples a direction of travel; pdf() is its pdf per steradian. From the phase function; at a
  /// surface with equal probability from Lambert's law or as the reflection of `incoming` at a GGX
  /// microfacet (Walter et al. 2007, eq. 35, 36 and 38).
  Vec3 sample(Generator& generator) const;
  double pdf(const Vec3& outgoing) const;

private:
  double facetPdf(const Vec3& h) const;

  Vec3 m_incoming;
  Rgb m_albedo;
  double m_g = 0.0;
  std::optional<SurfaceShading> m_shading;
  Vec3 m_normal = Vec3::Zero(); ///< unit, toward the path's origin
};

} // namespace fenestra::core::oracle
