#pragma once
// Scattering of light at a real collision, by the phase function or at a surface. Conventions:
// `incoming` is the direction in which the path travels (away from the eye), `outgoing` the
// direction in which the path continues (toward a light). evaluate() is the factor on radiance per
// steradian, with albedo and, at surfaces, the cosine included; pdf() is per steradian.

#include "base/Random.h"
#include "model/medium/TransferFunction.h"

#include <variant>

namespace fenestra {

struct ScatterSample {
  Vec3 outgoing;
  Rgb weight; ///< evaluate / pdf; zero ends the path
  double pdf;
};

/// Henyey-Greenstein 1941, times the albedo.
class PhaseScattering {
public:
  PhaseScattering(const Vec3& incoming, double g, const Rgb& albedo)
      : m_peak(g < 0.0 ? Vec3(-incoming) : incoming), m_g(std::abs(g)), m_albedo(albedo) {}

  double pdf(const Vec3& outgoing) const;
  Rgb evaluate(const Vec3& outgoing) const { return m_albedo * pdf(outgoing); }
  ScatterSample sample(const Vec2& u) const;

private:
  Vec3 m_peak; ///< incoming; -incoming for g < 0, as the lobe (g, d) equals (-g, -d)
  double m_g;  ///< |g|
  Rgb m_albedo;
};

/// A Lambert lobe of the albedo and a GGX lobe (Walter et al. 2007; visible normals by Heitz 2018)
/// with Schlick's Fresnel term F. Side by side they are weighted so that they never reflect more
/// than arrives. Under a coat that reflects E the Lambert lobe is
/// albedo / pi (1 - E(viewer)) (1 - E(outgoing)) / (1 - E_mean), which is reciprocal and returns,
/// for albedo 1, all but what the coat reflects (Kelemen, Szirmay-Kalos 2001).
class SurfaceScattering {
public:
  /// `gradient` must not be zero; the normal is -gradient, flipped to the side of the path's
  /// origin.
  SurfaceScattering(const Vec3& incoming, const Vec3& gradient, const SurfaceShading& shading,
                    const Rgb& albedo);

  double pdf(const Vec3& outgoing) const;
  Rgb evaluate(const Vec3& outgoing) const;
  /// `choice`, in [0, 1), selects the lobe.
  ScatterSample sample(double choice, const Vec2& u) const;

private:
  double lambertPdf(const Vec3& l) const { return std::max(l.z(), 0.0) / pi; }
  double fresnel(double cosine) const;
  /// Share of light that passes the coat.
  double belowCoat(double cosine) const { return 1.0 - m_coat(cosine); }
  double glossyPdf(const Vec3& l) const;
  double masking(const Vec3& v) const; ///< Smith's G1
  double normalDensity(const Vec3& h) const;
  Vec3 sampleVisibleNormal(const Vec2& u) const;

  Frame m_frame; ///< local z is the normal
  Vec3 m_viewer; ///< local direction back along the path
  Rgb m_diffuse; ///< weight * albedo, and what the coat lets through from the viewer
  double m_specular;
  double m_f0;
  bool m_isCoated;
  CoatReflectance m_coat;
  double m_roughness;
  double m_lambertShare; ///< probability that sample() takes the Lambert lobe
};

using Scattering = std::variant<PhaseScattering, SurfaceScattering>;

inline double scatterPdf(const Scattering& s, const Vec3& outgoing) {
  return std::visit([&](const auto& kind) { return kind.pdf(outgoing); }, s);
}
inline Rgb scatterEvaluate(const Scattering& s, const Vec3& outgoing) {
  return std::visit([&](const auto& kind) { return kind.evaluate(outgoing); }, s);
}
/// `u` gives the direction, `random` the choice of a lobe.
inline ScatterSample scatterSample(const Scattering& s, const Vec2& u, Random& random) {
  if (const auto* surface = std::get_if<SurfaceScattering>(&s))
    return surface->sample(random.uniform(), u);
  return std::get<PhaseScattering>(s).sample(u);
}

} // namespace fenestra
