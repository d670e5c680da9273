// Lights: SIMD version of model/lights/LightSet.h. Included inside a namespace, after
// Lookups-inl.h.

#include "integrator/simd/EnvironmentSampler-inl.h"
#include "model/lights/LightLoops-inl.h"

/// EmitterHit, one per lane.
struct LaneEmitterHit {
  Float3 radiance;
  Float pdf;
};
/// LightSet::evaluateEnvironment. selectTexel(map) returns a map's texel in `direction`.
template <typename SelectTexel>
HWY_INLINE LaneEmitterHit evaluateEnvironment(const SimdShading& shading, const Float3& direction,
                                              SelectTexel&& selectTexel) {
  LaneEmitterHit sum{evaluateSkies(shading.lights, direction), 0.0F};
  for (const EnvironmentTables& map : shading.maps) {
    const Float3 radiance = loadRadiance(map, selectTexel(map));
    sum.radiance = sum.radiance + radiance;
    sum.pdf = sum.pdf + map.pdfPerBrightness * maxComponent(radiance);
  }
  return sum;
}

/// Samples an environment map for the lanes of `which`. `choice`: as left by sampleLights.
inline void sampleMaps(const SimdShading& shading, LaneMask which, Float choice, UInt u, UInt v,
                       LightSamples& sampled) {
  const std::size_t count = shading.maps.size();
  TexelSample toward = sampleTexel(shading.maps[0], u, v);
  LaneMask later = which;
  for (std::size_t i = 1; i < count; ++i) { // rounding errors of the pmf go to the last map
    const float before = shading.maps[i - 1].pmf;
    later = later & (choice > before);
    choice = choice - before;
    if (later.any())
      toward.direction =
          select(later, sampleTexel(shading.maps[i], u, v).direction, toward.direction);
  }
  const LaneEmitterHit light =
      evaluateEnvironment(shading, toward.direction, [&](const EnvironmentTables& map) {
        return count == 1 ? toward.texel : findTexel(map, toward.direction);
      });
  const LaneMask lit = which & (light.pdf > 0.0F);
  sampled.direction = select(lit, toward.direction, sampled.direction);
  sampled.radiance = select(lit, light.radiance, sampled.radiance);
  sampled.pdf = select(lit, light.pdf, sampled.pdf);
}

/// LightSet::sample for the lanes of `which`, at points in local space (SimdShading). `uBits` and
/// `vBits` are random bits.
inline LightSamples sampleLightSet(const SimdShading& shading, LaneMask which, const Float3& point,
                                   Float choice, UInt uBits, UInt vBits) {
  const Float u = toUniform(uBits), v = toUniform(vBits);
  LightSamples sampled = sampleLights(shading.lights, which, point, choice, u, v);
  if (!shading.maps.empty() && which.any())
    sampleMaps(shading, which, choice, uBits, vBits, sampled);
  return sampled;
}

/// PathSteps::emittedAlongRay for rays in local space, for the lanes of `which`; 0 in the others.
inline Float3 emittedAlongRay(const SimdShading& shading, LaneMask which, const Float3& origin,
                              const Float3& direction, Float distance, Float scatterPdf) {
  Float3 sum{0.0F, 0.0F, 0.0F};
  intersectLights(shading.lights, which, origin, direction, distance,
                  [&](LaneMask hits, const Float3& radiance, Float pdf) {
                    sum = sum + zeroUnless(hits, weighScattering(scatterPdf, pdf) * radiance);
                  });
  const LaneMask escaped = which & (distance == infiniteReal);
  if (shading.maps.empty())
    return sum + zeroUnless(escaped, evaluateSkies(shading.lights, direction));
  if (!escaped.any())
    return sum;
  const LaneEmitterHit far = evaluateEnvironment(
      shading, direction, [&](const EnvironmentTables& map) { return findTexel(map, direction); });
  return sum + zeroUnless(escaped, weighScattering(scatterPdf, far.pdf) * far.radiance);
}
