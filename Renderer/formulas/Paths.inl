// Vertices of a path: normals, Russian roulette, weights of lights.

/// Unit normal toward a ray's origin, times `weight`; 0 where the gradient is 0. `alongRay`: the
/// gradient along the ray; only its sign counts.
FORMULA Float3 makeNormal(Float3 gradient, Float alongRay, Float weight) {
  const Float slope = sqrt(dot(gradient, gradient));
  return zeroUnless(slope > 0.0F, select(alongRay < 0.0F, weight, -weight) / slope * gradient);
}

/// Probability that Russian roulette keeps a path: its throughput (root mean square of the
/// channels), whose square measures what the path adds to the variance, over 1/2. NaN stays NaN,
/// and such a path ends.
FORMULA Float keepProbability(Float3 throughput) {
  const Float rms = sqrt(Real(0.3333333333333333) * dot(throughput, throughput));
  return min(1.0F, rms * 2.0F);
}

/// Radiance that a sampled light adds to a path, per transmittance toward it, weighted by the
/// balance heuristic (Veach 1997, eq. 9.8) against scattering toward it.
FORMULA Float3 weighLight(Float3 radiance, Float pdf, LaneMask isDelta, ScatterEval scattered,
                          Float3 throughput) {
  const Float sum = pdf + select(isDelta, 0.0F, scattered.pdf);
  return (1.0F / sum) * (throughput * scattered.factor * radiance);
}
/// Weight of light that a scattered ray finds, against sampling that light: pdf of either.
FORMULA Float weighScattering(Float scatterPdf, Float lightPdf) {
  return scatterPdf / (scatterPdf + lightPdf);
}
