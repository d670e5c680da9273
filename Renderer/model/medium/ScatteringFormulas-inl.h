// Scattering formulas, written once for scalar and SIMD code. Include after
// model/medium/BsdfParameters.h, inside the namespace that defines Float (base/ScalarMath.h).

/// Factor of scattering on radiance toward a direction, and the sampling density of that direction.
struct ScatterEval {
  Float3 factor;
  Float pdf;
};
struct ScatterSamples {
  Float3 outgoing;
  Float3 weight; ///< factor / pdf
  Float pdf;
};

/// Density of uniformly distributed directions.
inline constexpr Real uniformPdf = static_cast<Real>(0.25 / pi);

/// Henyey-Greenstein 1941, times the albedo. `Number`: type of g, Real or Float.
template <typename Number>
class PhaseLobe {
public:
  FENESTRA_INLINE PhaseLobe(Number g, const Float3& incoming, const Float3& albedo)
      : m_g(abs(g)), m_peak(flipIfNegative(g, incoming)), m_albedo(albedo) {}

  FENESTRA_INLINE ScatterEval evaluate(const Float3& outgoing) const {
    const Float3 chord = outgoing - m_peak;
    const Float pdf = evaluatePdf(dot(chord, chord));
    return {pdf * m_albedo, pdf};
  }

  FENESTRA_INLINE ScatterSamples sample(Float u, Float v) const {
    const CosineSine phi = cosSinTurns(v);
    if (isAllEqual(m_g, 0.0F)) {
      const Float z = fnma(2.0F, u, 1.0F);
      const Float r = safeSqrt(fnma(z, z, 1.0F));
      return {{r * phi.cosine, r * phi.sine, z}, m_albedo, uniformPdf};
    }
    // cos = (1 + g^2 - ((1 - g^2) / (1 + g - 2 g u))^2) / (2 g), rearranged for accuracy near 1:
    // with a = 1 + g - 2 g u, 1 - cos = 2 u (1 - g)^2 (1 + g (1 - u)) / a^2.
    const Float g = m_g;
    const Float a = fnma(2.0F * m_g, u, 1.0F + m_g);
    const Float part = (2.0F * (1.0F - m_g) * (1.0F - m_g)) * u;
    const Float rest = fma(g, 1.0F - u, 1.0F);
    const Float oneMinusCosine = min(part * rest / square(a), 2.0F);
    const Float cosine = 1.0F - oneMinusCosine;
    const Float sine = safeSqrt(oneMinusCosine * (1.0F + cosine));
    const Float3 local{sine * phi.cosine, sine * phi.sine, cosine};
    return {normalize(Frames(m_peak).toWorld(local)), m_albedo, evaluatePdf(2.0F * oneMinusCosine)};
  }

private:
  /// Density of a direction; chord2: squared distance of that unit vector from the lobe's peak,
  /// which is 2 (1 - cos). So 1 + g^2 - 2 g cos needs no cancellation where g and cos are near 1.
  FENESTRA_INLINE Float evaluatePdf(Float chord2) const {
    if (isAllEqual(m_g, 0.0F))
      return uniformPdf;
    const Float d = fma(m_g, chord2, (1.0F - m_g) * (1.0F - m_g));
    return (uniformPdf * (1.0F - m_g) * (1.0F + m_g)) / (d * sqrt(d));
  }

  Number m_g;    ///< |g|
  Float3 m_peak; ///< incoming; -incoming for g < 0, as the lobe (g, d) equals (-g, -d)
  Float3 m_albedo;
};

/// A Lambert lobe of the albedo and a GGX lobe (Walter et al. 2007; visible normals by Heitz 2018)
/// with Schlick's Fresnel term F. Without a coat, the lobes' weights sum to at most 1, so that
/// energy is conserved. Under a coat of directional albedo E the Lambert lobe is
/// albedo / pi (1 - E(viewer)) (1 - E(outgoing)) / (1 - E_mean), which is reciprocal and, for
/// albedo 1, returns all light that the coat transmits (Kelemen, Szirmay-Kalos 2001). `Number`:
/// type of the parameters, Real or Float.
template <typename Number>
class SurfaceLobes {
public:
  /// `gradient` must not be zero. The normal is -gradient, turned to the side that the path comes
  /// from.
  FENESTRA_INLINE SurfaceLobes(const BsdfParameters<Number>& bsdf, const Float3& incoming,
                               const Float3& gradient, const Float3& albedo)
      : m_specular(bsdf.specular),
        m_f0(bsdf.f0),
        m_roughness(bsdf.roughness),
        m_isCoated(bsdf.isCoated),
        m_coat(bsdf.coat),
        m_frame(normalize(select(dot(incoming, gradient) >= 0.0F, -gradient, gradient))),
        m_viewer(m_frame.toLocal(-incoming)),
        m_diffuse(bsdf.diffuse * albedo) {
    if (!isAllEqual(bsdf.oddsFactor, 1.0F))
      m_diffuse = bsdf.diffuse * scaleOdds(bsdf.oddsFactor, albedo);
    if (m_isCoated)
      m_diffuse = coatTransmittance(m_viewer.z) * m_diffuse;
    const Float lambert = maxComponent(m_diffuse);
    const Float sum = fma(m_specular, fresnel(m_viewer.z), lambert);
    const LaneMask some = sum > 0.0F;
    m_lambertPmf = select(some, lambert / sum, 1.0F);
  }

  FENESTRA_INLINE ScatterEval evaluate(const Float3& outgoing) const {
    return evaluateLocal(m_frame.toLocal(outgoing));
  }

  /// `choice` selects the lobe.
  FENESTRA_INLINE ScatterSamples sample(Float choice, Float u, Float v) const {
    const CosineSine phi = cosSinTurns(v);
    const Float r = sqrt(u);
    const Float3 lambert{r * phi.cosine, r * phi.sine, safeSqrt(1.0F - u)};
    Float3 local = lambert;
    if (!isAllEqual(m_specular, 0.0F)) {
      const Float3 h = sampleVisibleNormal(r, phi);
      const Float3 glossy = (2.0F * dot(m_viewer, h)) * h - m_viewer;
      local = select(choice < m_lambertPmf, lambert, glossy);
    }
    const Float3 outgoing = normalize(m_frame.toWorld(local));
    const ScatterEval s = evaluate(outgoing);
    const LaneMask possible = s.pdf > 0.0F;
    return {outgoing, zeroUnless(possible, (1.0F / s.pdf) * s.factor), s.pdf};
  }

private:
  /// Schlick 1994.
  FENESTRA_INLINE Float fresnel(Float cosine) const {
    const Float x = clampZero(min(1.0F - cosine, 1.0F));
    return fma(1.0F - m_f0, square(square(x)) * x, m_f0);
  }
  /// Multiplies the odds a / (1 - a) of an albedo a.
  static FENESTRA_INLINE Float3 scaleOdds(Number oddsFactor, const Float3& albedo) {
    const auto channel = [oddsFactor](Float a) {
      return oddsFactor * a / fnma(1.0F - oddsFactor, a, 1.0F);
    };
    return {channel(albedo.x), channel(albedo.y), channel(albedo.z)};
  }
  /// Fraction of light that the coat transmits.
  FENESTRA_INLINE Float coatTransmittance(Float cosine) const {
    const Float x = clampZero(min(1.0F - cosine, 1.0F));
    const Float x2 = square(x), x4 = square(x2);
    const Float high = fma(m_coat[3], x4, m_coat[2]);
    const Float low = fma(m_coat[1], x2, m_coat[0]);
    return 1.0F - fma(high, x4, low);
  }

  /// The GGX lobe is D F G / (4 cos cos) times the outgoing cosine, with separable Smith G; its
  /// density is Heitz 2018, eq. 17.
  FENESTRA_INLINE ScatterEval evaluateLocal(const Float3& l) const {
    const Float lambertPdf = clampZero(l.z) * static_cast<Real>(1.0 / pi);
    ScatterEval s{lambertPdf * m_diffuse, m_lambertPmf * lambertPdf};
    if (isAllEqual(m_specular, 0.0F))
      return s;
    if (m_isCoated)
      s.factor = coatTransmittance(l.z) * s.factor;
    const Float3 h = normalize(l + m_viewer);
    const Float perViewer = smithG1(m_viewer) * evaluateNdf(h) / (4.0F * m_viewer.z);
    const LaneMask facing = (l.z > 0.0F) & (m_viewer.z > 0.0F);
    const Float pdf = zeroUnless(facing, perViewer);
    s.pdf = fma(1.0F - m_lambertPmf, pdf, s.pdf);
    const Float glossy = m_specular * fresnel(dot(l, h)) * smithG1(l);
    const Float value = zeroUnless(facing, glossy * perViewer);
    s.factor = s.factor + Float3{value, value, value};
    return s;
  }

  /// Smith's G1.
  FENESTRA_INLINE Float smithG1(const Float3& v) const {
    const Float sine2 = fma(v.x, v.x, square(v.y));
    const Float cosine = abs(v.z);
    const Float slope = sqrt(fma(m_roughness * m_roughness, sine2, square(cosine)));
    return 2.0F * cosine / (cosine + slope);
  }

  FENESTRA_INLINE Float evaluateNdf(const Float3& h) const {
    const Float a2 = (m_roughness * m_roughness);
    const Float d = fma(h.x, h.x, fma(h.y, h.y, a2 * square(h.z)));
    return a2 / (static_cast<Real>(pi) * square(d));
  }

  /// Heitz 2018, listing 1; `r`, `phi`: polar coordinates of a point in the unit disk.
  FENESTRA_INLINE Float3 sampleVisibleNormal(Float r, const CosineSine& phi) const {
    const Float a = m_roughness;
    const Float3 stretched = normalize({a * m_viewer.x, a * m_viewer.y, m_viewer.z});
    const Float length2 = fma(stretched.x, stretched.x, square(stretched.y));
    const LaneMask slanted = length2 > 0.0F;
    const Float perLength = 1.0F / sqrt(select(slanted, length2, 1.0F));
    const Float3 side = select(slanted, perLength * Float3{-stretched.y, stretched.x, 0.0F},
                               Float3{1.0F, 0.0F, 0.0F});
    const Float3 other = cross(stretched, side);
    const Float p1 = r * phi.cosine;
    const Float s = 0.5F * (1.0F + stretched.z);
    const Float p2 = lerp(safeSqrt(fnma(p1, p1, 1.0F)), r * phi.sine, s);
    const Float p3 = safeSqrt(fnma(p1, p1, fnma(p2, p2, 1.0F)));
    const Float3 n = p1 * side + p2 * other + p3 * stretched;
    return normalize({a * n.x, a * n.y, max(n.z, std::numeric_limits<Real>::min())});
  }

  Number m_specular, m_f0, m_roughness;
  bool m_isCoated;
  std::array<Number, 4> m_coat;
  Frames m_frame;     ///< local z is the normal
  Float3 m_viewer;    ///< local direction back along the path
  Float3 m_diffuse;   ///< weight * albedo * coat transmittance toward the viewer
  Float m_lambertPmf; ///< probability that sample() selects the Lambert lobe
};
