// Scattering of many paths: model/medium/Scattering.h in lanes. Compiled once for each instruction
// set (see PathSteps.cxx).

#if defined(FENESTRA_WIDE_SCATTERING_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef FENESTRA_WIDE_SCATTERING_INL_H
#undef FENESTRA_WIDE_SCATTERING_INL_H
#else
#define FENESTRA_WIDE_SCATTERING_INL_H
#endif

#include "base/Lanes-inl.h"
#include "transport/lanes/PathTables.h"

HWY_BEFORE_NAMESPACE();
namespace fenestra::HWY_NAMESPACE {

/// Factor of scattering on radiance toward a direction, and the density of drawing that direction.
struct Scattered {
  F3 factor;
  F pdf;
};
struct ScatterDraw {
  F3 outgoing;
  F3 weight; ///< factor / pdf
  F pdf;
};

inline constexpr float perSphere = static_cast<float>(0.25 / pi);

class WidePhase {
public:
  HWY_INLINE WidePhase(const EventScene& scene, const F3& incoming, const F3& albedo)
      : m_g(std::abs(scene.g)), m_peak(scene.g < 0.0F ? -incoming : incoming), m_albedo(albedo) {}

  HWY_INLINE Scattered toward(const F3& outgoing) const {
    const F3 chord = outgoing - m_peak;
    const F pdf = density(dot(chord, chord));
    return {pdf * m_albedo, pdf};
  }

  HWY_INLINE ScatterDraw draw(F u, F v) const {
    const F one = all(1.0F);
    const CosineSine phi = ofTurns(v);
    if (m_g == 0.0F) {
      const F z = hn::NegMulAdd(all(2.0F), u, one);
      const F r = root(hn::NegMulAdd(z, z, one));
      return {{hn::Mul(r, phi.cosine), hn::Mul(r, phi.sine), z}, m_albedo, all(perSphere)};
    }
    // PhaseScattering::sample's formula, in 1 - cos.
    const F g = all(m_g);
    const F a = hn::NegMulAdd(all(2.0F * m_g), u, all(1.0F + m_g));
    const F part = hn::Mul(all(2.0F * (1.0F - m_g) * (1.0F - m_g)), u);
    const F rest = hn::MulAdd(g, hn::Sub(one, u), one);
    const F oneMinusCosine = hn::Min(hn::Div(hn::Mul(part, rest), square(a)), all(2.0F));
    const F cosine = hn::Sub(one, oneMinusCosine);
    const F sine = root(hn::Mul(oneMinusCosine, hn::Add(one, cosine)));
    const F3 local{hn::Mul(sine, phi.cosine), hn::Mul(sine, phi.sine), cosine};
    return {normalized(Frames(m_peak).toWorld(local)), m_albedo,
            density(hn::Mul(all(2.0F), oneMinusCosine))};
  }

private:
  /// Density of a direction; chord2: squared distance of that unit vector from the lobe's peak.
  HWY_INLINE F density(F chord2) const {
    if (m_g == 0.0F)
      return all(perSphere);
    const F d = hn::MulAdd(all(m_g), chord2, all((1.0F - m_g) * (1.0F - m_g)));
    return hn::Div(all(perSphere * (1.0F - m_g) * (1.0F + m_g)), hn::Mul(d, hn::Sqrt(d)));
  }

  float m_g; ///< |g|
  F3 m_peak;
  F3 m_albedo;
};

class WideSurface {
public:
  HWY_INLINE WideSurface(const EventScene& scene, const F3& incoming, const F3& gradient,
                         const F3& albedo)
      : m_specular(scene.specular),
        m_f0(scene.f0),
        m_roughness(scene.roughness),
        m_isCoated(scene.isCoated),
        m_coat(scene.coat),
        m_frame(normalized(
            select(hn::Ge(dot(incoming, gradient), hn::Zero(floats)), -gradient, gradient))),
        m_viewer(m_frame.toLocal(-incoming)),
        m_diffuse(all(scene.diffuse) * albedo) {
    if (scene.odds != 1.0F)
      m_diffuse = all(scene.diffuse) * ofOdds(scene.odds, albedo);
    if (m_isCoated)
      m_diffuse = belowCoat(m_viewer.z) * m_diffuse;
    const F lambert = greatest(m_diffuse);
    const F sum = hn::MulAdd(all(m_specular), fresnel(m_viewer.z), lambert);
    const M some = hn::Gt(sum, hn::Zero(floats));
    m_lambertShare = hn::IfThenElse(some, hn::Div(lambert, sum), all(1.0F));
  }

  HWY_INLINE Scattered toward(const F3& outgoing) const {
    return towardLocal(m_frame.toLocal(outgoing));
  }

  HWY_INLINE ScatterDraw draw(F choice, F u, F v) const {
    const CosineSine phi = ofTurns(v);
    const F r = hn::Sqrt(u);
    const F3 lambert{hn::Mul(r, phi.cosine), hn::Mul(r, phi.sine), root(hn::Sub(all(1.0F), u))};
    F3 local = lambert;
    if (m_specular > 0.0F) {
      const F3 h = visibleNormal(r, phi);
      const F3 glossy = hn::Mul(all(2.0F), dot(m_viewer, h)) * h - m_viewer;
      local = select(hn::Lt(choice, m_lambertShare), lambert, glossy);
    }
    const F3 outgoing = normalized(m_frame.toWorld(local));
    const Scattered s = toward(outgoing);
    const M possible = hn::Gt(s.pdf, hn::Zero(floats));
    return {outgoing, selectElseZero(possible, hn::Div(all(1.0F), s.pdf) * s.factor), s.pdf};
  }

private:
  HWY_INLINE F fresnel(F cosine) const {
    const F x = notBelow0(hn::Min(hn::Sub(all(1.0F), cosine), all(1.0F)));
    return hn::MulAdd(all(1.0F - m_f0), hn::Mul(square(square(x)), x), all(m_f0));
  }
  /// Albedo whose odds are `odds` times those of the given one.
  static HWY_INLINE F3 ofOdds(float odds, const F3& albedo) {
    const auto channel = [odds](F a) {
      return hn::Div(hn::Mul(all(odds), a), hn::NegMulAdd(all(1.0F - odds), a, all(1.0F)));
    };
    return {channel(albedo.x), channel(albedo.y), channel(albedo.z)};
  }
  /// Share of light that passes the coat.
  HWY_INLINE F belowCoat(F cosine) const {
    const F x = notBelow0(hn::Min(hn::Sub(all(1.0F), cosine), all(1.0F)));
    const F x2 = square(x), x4 = square(x2);
    const F high = hn::MulAdd(all(m_coat[3]), x4, all(m_coat[2]));
    const F low = hn::MulAdd(all(m_coat[1]), x2, all(m_coat[0]));
    return hn::Sub(all(1.0F), hn::MulAdd(high, x4, low));
  }

  /// SurfaceScattering's evaluate() and pdf().
  HWY_INLINE Scattered towardLocal(const F3& l) const {
    const F lambertPdf = hn::Mul(notBelow0(l.z), all(static_cast<float>(1.0 / pi)));
    Scattered s{lambertPdf * m_diffuse, hn::Mul(m_lambertShare, lambertPdf)};
    if (!(m_specular > 0.0F))
      return s;
    if (m_isCoated)
      s.factor = belowCoat(l.z) * s.factor;
    const F zero = hn::Zero(floats);
    const F3 h = normalized(l + m_viewer);
    const F perViewer =
        hn::Div(hn::Mul(masking(m_viewer), normalDensity(h)), hn::Mul(all(4.0F), m_viewer.z));
    const M facing = hn::And(hn::Gt(l.z, zero), hn::Gt(m_viewer.z, zero));
    const F pdf = hn::IfThenElseZero(facing, perViewer);
    s.pdf = hn::MulAdd(hn::Sub(all(1.0F), m_lambertShare), pdf, s.pdf);
    const F glossy = hn::Mul(hn::Mul(all(m_specular), fresnel(dot(l, h))), masking(l));
    const F value = hn::IfThenElseZero(facing, hn::Mul(glossy, perViewer));
    s.factor = s.factor + F3{value, value, value};
    return s;
  }

  /// Smith's G1.
  HWY_INLINE F masking(const F3& v) const {
    const F sine2 = hn::MulAdd(v.x, v.x, square(v.y));
    const F cosine = hn::Abs(v.z);
    const F slope = hn::Sqrt(hn::MulAdd(all(m_roughness * m_roughness), sine2, square(cosine)));
    return hn::Div(hn::Mul(all(2.0F), cosine), hn::Add(cosine, slope));
  }

  HWY_INLINE F normalDensity(const F3& h) const {
    const F a2 = all(m_roughness * m_roughness);
    const F d = hn::MulAdd(h.x, h.x, hn::MulAdd(h.y, h.y, hn::Mul(a2, square(h.z))));
    return hn::Div(a2, hn::Mul(all(static_cast<float>(pi)), square(d)));
  }

  /// Heitz 2018, listing 1; `r`, `phi`: polar coordinates of a point in the unit disc.
  HWY_INLINE F3 visibleNormal(F r, const CosineSine& phi) const {
    const F a = all(m_roughness);
    const F one = all(1.0F);
    const F3 stretched = normalized({hn::Mul(a, m_viewer.x), hn::Mul(a, m_viewer.y), m_viewer.z});
    const F length2 = hn::MulAdd(stretched.x, stretched.x, square(stretched.y));
    const M slanted = hn::Gt(length2, hn::Zero(floats));
    const F perLength = hn::Div(one, hn::Sqrt(hn::IfThenElse(slanted, length2, one)));
    const F zero = hn::Zero(floats);
    const F3 side = select(slanted, perLength * F3{hn::Neg(stretched.y), stretched.x, zero},
                           F3{one, zero, zero});
    const F3 other = cross(stretched, side);
    const F p1 = hn::Mul(r, phi.cosine);
    const F s = hn::Mul(all(0.5F), hn::Add(one, stretched.z));
    const F p2 = lerp(root(hn::NegMulAdd(p1, p1, one)), hn::Mul(r, phi.sine), s);
    const F p3 = root(hn::NegMulAdd(p1, p1, hn::NegMulAdd(p2, p2, one)));
    const F3 n = p1 * side + p2 * other + p3 * stretched;
    return normalized(
        {hn::Mul(a, n.x), hn::Mul(a, n.y), hn::Max(n.z, all(std::numeric_limits<float>::min()))});
  }

  float m_specular, m_f0, m_roughness;
  bool m_isCoated;
  std::array<float, 4> m_coat;
  Frames m_frame; ///< local z is the normal
  F3 m_viewer;    ///< local direction back along the path
  F3 m_diffuse;
  F m_lambertShare;
};

} // namespace fenestra::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
