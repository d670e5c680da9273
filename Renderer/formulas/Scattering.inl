// Scattering at a real collision: the phase function, and the lobes of a surface. `incoming` is the
// direction in which the path travels, `outgoing` that in which it continues.

/// 1 - e^-x.
FORMULA Float oneMinusExp(Float x) {
  return -expm1(-x);
}

/// Probability that a path scatters at a surface (Kroes, Post, Botha 2012), with opacity and
/// gradient over 1 mm: o (1 - exp(-25 gamma^3 m)). `extinction`: mm^-1; rate: 25 gamma^3; slope:
/// |gradient|, in spans of the transfer function per mm.
FORMULA Float surfaceProbability(Float extinction, Real rate, Float slope) {
  return oneMinusExp(extinction) * oneMinusExp(rate * slope);
}

/// Factor of scattering on radiance toward a direction, and the sampling density of that direction.
struct ScatterEval {
  Float3 factor; ///< per steradian; includes the albedo and, at surfaces, the cosine
  Float pdf;     ///< per steradian
};
struct ScatterSamples {
  Float3 outgoing;
  Float3 weight; ///< factor / pdf
  Float pdf;     ///< per steradian
};

/// Scattering parameters except the albedo.
struct Bsdf {
  Float g;
  Float diffuse, specular, f0, oddsFactor, roughness; ///< as in SurfaceShading
  Float coat[4];                                      ///< CoatReflectance over the Lambert lobe
  bool isCoated;                                      ///< false: `coat` is 0 in all lanes
};

/// Density of uniformly distributed directions: 1 / (4 pi).
CONSTANT Real uniformPdf = Real(0.07957747154594767);

/// Henyey-Greenstein 1941, times the albedo.
struct PhaseLobe {
  Float g;     ///< |g|
  Float3 peak; ///< incoming; -incoming for g < 0, as the lobe (g, d) equals (-g, -d)
  Float3 albedo;
};
FORMULA PhaseLobe makePhaseLobe(Float g, Float3 incoming, Float3 albedo) {
  PhaseLobe lobe;
  lobe.g = abs(g);
  lobe.peak = flipIfNegative(g, incoming);
  lobe.albedo = albedo;
  return lobe;
}

/// Density of a direction; chord2: squared distance of that unit vector from the lobe's peak, which
/// is 2 (1 - cos). So 1 + g^2 - 2 g cos needs no cancellation where g and cos are near 1.
FORMULA Float evaluatePhasePdf(Float g, Float chord2) {
  if (isAllEqual(g, 0.0F))
    return uniformPdf;
  const Float d = fma(g, chord2, (1.0F - g) * (1.0F - g));
  return (uniformPdf * (1.0F - g) * (1.0F + g)) / (d * sqrt(d));
}

FORMULA ScatterEval evaluate(STRUCT(PhaseLobe) lobe, Float3 outgoing) {
  const Float3 chord = outgoing - lobe.peak;
  ScatterEval s;
  s.pdf = evaluatePhasePdf(lobe.g, dot(chord, chord));
  s.factor = s.pdf * lobe.albedo;
  return s;
}

FORMULA ScatterSamples sampleLobe(STRUCT(PhaseLobe) lobe, Float u, Float v) {
  const CosineSine phi = cosSinTurns(v);
  ScatterSamples s;
  s.weight = lobe.albedo;
  if (isAllEqual(lobe.g, 0.0F)) {
    const Float z = fnma(2.0F, u, 1.0F);
    const Float r = safeSqrt(fnma(z, z, 1.0F));
    s.outgoing = Float3(r * phi.cosine, r * phi.sine, z);
    s.pdf = uniformPdf;
    return s;
  }
  // cos = (1 + g^2 - ((1 - g^2) / (1 + g - 2 g u))^2) / (2 g), rearranged for accuracy near 1:
  // with a = 1 + g - 2 g u, 1 - cos = 2 u (1 - g)^2 (1 + g (1 - u)) / a^2.
  const Float g = lobe.g;
  const Float a = fnma(2.0F * g, u, 1.0F + g);
  const Float part = (2.0F * (1.0F - g) * (1.0F - g)) * u;
  const Float rest = fma(g, 1.0F - u, 1.0F);
  const Float oneMinusCosine = min(part * rest / square(a), 2.0F);
  const Float cosine = 1.0F - oneMinusCosine;
  const Float sine = safeSqrt(oneMinusCosine * (1.0F + cosine));
  const Float3 local = Float3(sine * phi.cosine, sine * phi.sine, cosine);
  s.outgoing = normalize(fromFrame(makeFrames(lobe.peak), local));
  s.pdf = evaluatePhasePdf(g, 2.0F * oneMinusCosine);
  return s;
}

/// A Lambert lobe of the albedo and a GGX lobe (Walter et al. 2007; visible normals by Heitz 2018)
/// with Schlick's Fresnel term F. Without a coat, the lobes' weights sum to at most 1, so that
/// energy is conserved. Under a coat of directional albedo E the Lambert lobe is
/// albedo / pi (1 - E(viewer)) (1 - E(outgoing)) / (1 - E_mean), which is reciprocal and, for
/// albedo 1, returns all light that the coat transmits (Kelemen, Szirmay-Kalos 2001).
struct SurfaceLobes {
  Bsdf bsdf;
  Frames frame;     ///< local z is the normal
  Float3 viewer;    ///< local direction back along the path
  Float3 diffuse;   ///< weight * albedo * coat transmittance toward the viewer
  Float lambertPmf; ///< probability that sampleLobe() selects the Lambert lobe
};

/// Schlick 1994.
FORMULA Float fresnel(Float f0, Float cosine) {
  const Float x = clampZero(min(1.0F - cosine, 1.0F));
  return fma(1.0F - f0, square(square(x)) * x, f0);
}

/// Multiplies the odds a / (1 - a) of an albedo a.
FORMULA Float scaleOdds(Float oddsFactor, Float a) {
  return oddsFactor * a / fnma(1.0F - oddsFactor, a, 1.0F);
}

/// Fraction of light that the coat transmits.
FORMULA Float coatTransmittance(STRUCT(Bsdf) bsdf, Float cosine) {
  const Float x = clampZero(min(1.0F - cosine, 1.0F));
  const Float x2 = square(x);
  const Float x4 = square(x2);
  const Float high = fma(bsdf.coat[3], x4, bsdf.coat[2]);
  const Float low = fma(bsdf.coat[1], x2, bsdf.coat[0]);
  return 1.0F - fma(high, x4, low);
}

/// `gradient` must not be zero. The normal is -gradient, turned to the side that the path comes
/// from.
FORMULA SurfaceLobes makeSurfaceLobes(STRUCT(Bsdf) bsdf, Float3 incoming, Float3 gradient,
                                      Float3 albedo) {
  SurfaceLobes lobes;
  lobes.bsdf = bsdf;
  lobes.frame = makeFrames(normalize(select(dot(incoming, gradient) >= 0.0F, -gradient, gradient)));
  lobes.viewer = toFrame(lobes.frame, -incoming);
  Float3 odds = albedo;
  if (!isAllEqual(bsdf.oddsFactor, 1.0F))
    odds = Float3(scaleOdds(bsdf.oddsFactor, albedo.x), scaleOdds(bsdf.oddsFactor, albedo.y),
                  scaleOdds(bsdf.oddsFactor, albedo.z));
  lobes.diffuse = bsdf.diffuse * odds;
  if (bsdf.isCoated)
    lobes.diffuse = coatTransmittance(bsdf, lobes.viewer.z) * lobes.diffuse;
  const Float lambert = maxComponent(lobes.diffuse);
  const Float sum = fma(bsdf.specular, fresnel(bsdf.f0, lobes.viewer.z), lambert);
  lobes.lambertPmf = select(sum > 0.0F, lambert / sum, 1.0F);
  return lobes;
}

/// Smith's G1.
FORMULA Float smithG1(Float roughness, Float3 v) {
  const Float sine2 = fma(v.x, v.x, square(v.y));
  const Float cosine = abs(v.z);
  const Float slope = sqrt(fma(roughness * roughness, sine2, square(cosine)));
  return 2.0F * cosine / (cosine + slope);
}

/// Density of microfacet normals.
FORMULA Float evaluateGgx(Float roughness, Float3 h) {
  const Float a2 = roughness * roughness;
  const Float d = fma(h.x, h.x, fma(h.y, h.y, a2 * square(h.z)));
  return a2 / (Real(3.141592653589793) * square(d));
}

/// The GGX lobe is D F G / (4 cos cos) times the outgoing cosine, with separable Smith G; its
/// density is Heitz 2018, eq. 17. `l`: outgoing direction, local.
FORMULA ScatterEval evaluateLocal(STRUCT(SurfaceLobes) lobes, Float3 l) {
  const Float lambertPdf = clampZero(l.z) * Real(0.3183098861837907); // 1 / pi
  ScatterEval s;
  s.factor = lambertPdf * lobes.diffuse;
  s.pdf = lobes.lambertPmf * lambertPdf;
  if (isAllEqual(lobes.bsdf.specular, 0.0F))
    return s;
  if (lobes.bsdf.isCoated)
    s.factor = coatTransmittance(lobes.bsdf, l.z) * s.factor;
  const Float roughness = lobes.bsdf.roughness;
  const Float3 h = normalize(l + lobes.viewer);
  const Float perViewer =
      smithG1(roughness, lobes.viewer) * evaluateGgx(roughness, h) / (4.0F * lobes.viewer.z);
  const LaneMask facing = both(l.z > 0.0F, lobes.viewer.z > 0.0F);
  const Float pdf = zeroUnless(facing, perViewer);
  s.pdf = fma(1.0F - lobes.lambertPmf, pdf, s.pdf);
  const Float glossy =
      lobes.bsdf.specular * fresnel(lobes.bsdf.f0, dot(l, h)) * smithG1(roughness, l);
  const Float value = zeroUnless(facing, glossy * perViewer);
  s.factor = s.factor + Float3(value, value, value);
  return s;
}

FORMULA ScatterEval evaluate(STRUCT(SurfaceLobes) lobes, Float3 outgoing) {
  return evaluateLocal(lobes, toFrame(lobes.frame, outgoing));
}

/// Heitz 2018, listing 1; `r`, `phi`: polar coordinates of a point in the unit disk.
FORMULA Float3 sampleVisibleNormal(STRUCT(SurfaceLobes) lobes, Float r, CosineSine phi) {
  const Float a = lobes.bsdf.roughness;
  const Float3 stretched =
      normalize(Float3(a * lobes.viewer.x, a * lobes.viewer.y, lobes.viewer.z));
  const Float length2 = fma(stretched.x, stretched.x, square(stretched.y));
  const LaneMask slanted = length2 > 0.0F;
  const Float perLength = 1.0F / sqrt(select(slanted, length2, 1.0F));
  const Float3 side = select(slanted, perLength * Float3(-stretched.y, stretched.x, 0.0F),
                             Float3(1.0F, 0.0F, 0.0F));
  const Float3 other = cross(stretched, side);
  const Float p1 = r * phi.cosine;
  const Float s = 0.5F * (1.0F + stretched.z);
  const Float p2 = lerp(safeSqrt(fnma(p1, p1, 1.0F)), r * phi.sine, s);
  const Float p3 = safeSqrt(fnma(p1, p1, fnma(p2, p2, 1.0F)));
  const Float3 n = p1 * side + p2 * other + p3 * stretched;
  return normalize(Float3(a * n.x, a * n.y, max(n.z, tinyReal)));
}

/// `choice` selects the lobe.
FORMULA ScatterSamples sampleLobe(STRUCT(SurfaceLobes) lobes, Float choice, Float u, Float v) {
  const CosineSine phi = cosSinTurns(v);
  const Float r = sqrt(u);
  Float3 local = Float3(r * phi.cosine, r * phi.sine, safeSqrt(1.0F - u));
  if (!isAllEqual(lobes.bsdf.specular, 0.0F)) {
    const Float3 h = sampleVisibleNormal(lobes, r, phi);
    const Float3 glossy = (2.0F * dot(lobes.viewer, h)) * h - lobes.viewer;
    local = select(choice < lobes.lambertPmf, local, glossy);
  }
  ScatterSamples s;
  s.outgoing = normalize(fromFrame(lobes.frame, local));
  const ScatterEval at = evaluate(lobes, s.outgoing);
  s.weight = zeroUnless(at.pdf > 0.0F, (1.0F / at.pdf) * at.factor);
  s.pdf = at.pdf;
  return s;
}
