// Sampling of one light, as seen from a point, and its intersection with rays.

/// Samples of lights; radiance 0: invalid.
struct LightSamples {
  Float3 direction; ///< unit, from the point toward the light
  Float3 radiance;  ///< incident; for a directional light its irradiance
  Float distance;   ///< mm; infinity for environment and directional lights
  Float pdf;        ///< per steradian, times the light's pmf; for a directional light the pmf alone
  LaneMask isDelta; ///< true for a directional light: scattering never samples its direction
};

/// Samples a point on the light.
FORMULA LightSamples sampleLight(STRUCT(PlacedArea) light, Float3 point, Float u, Float v) {
  Float x = fms(2.0F, u, 1.0F);
  Float y = fms(2.0F, v, 1.0F);
  if (light.isDisk) {
    const CosineSine phi = cosSinTurns(v);
    const Float r = sqrt(u);
    x = r * phi.cosine;
    y = r * phi.sine;
  }
  const Float3 d = Float3(light.center) + x * Float3(light.right) + y * Float3(light.up) - point;
  const Float distance2 = dot(d, d);
  const Float distance = sqrt(distance2);
  const Float3 direction = (1.0F / distance) * d;
  const Float cosine = -dot(Float3(light.normal), direction);
  // No valid direction behind the light, in its plane, or on the light itself.
  const LaneMask isSeparate = distance2 >= tinyReal;
  const LaneMask lit = both(isSeparate, cosine > 0.0F);
  LightSamples samples;
  samples.direction = direction;
  samples.radiance = zeroUnless(lit, Float3(light.radiance));
  samples.distance = distance;
  samples.pdf = light.pmf * distance2 / (light.area * cosine);
  samples.isDelta = noLanes();
  return samples;
}

/// 1 - cos of half the angle that a sphere subtends, as sin^2 / (1 + cos), which is accurate for
/// narrow cones; 2 from inside: all directions. The solid angle is 2 pi times that.
FORMULA Float computeSpread(STRUCT(PlacedSphere) light, Float distance2) {
  const Float sine2 = light.radius2 / distance2; // 0 / 0 = NaN at the center of a tiny sphere
  const Float cosine = sqrt(max(1.0F - sine2, 0.0F));
  return select(sine2 < 1.0F, sine2 / (1.0F + cosine), 2.0F);
}
FORMULA Float computePdf(STRUCT(PlacedSphere) light, Float spread) {
  return light.pmf / (Real(6.283185307179586) * spread);
}
/// Distance along a ray to a sphere. The ray passes the center after the length `along`, at the
/// squared distance `across2`.
FORMULA Float computeDistance(STRUCT(PlacedSphere) light, Float distance2, Float along,
                              Float across2) {
  const Float outside = distance2 - light.radius2;
  const Float halfChord = sqrt(max(light.radius2 - across2, 0.0F));
  const Float far = along + halfChord;
  return select(outside > 0.0F, outside / far, far); // outside = near * far
}

/// Samples a direction in the cone that the sphere subtends.
FORMULA LightSamples sampleLight(STRUCT(PlacedSphere) light, Float3 point, Float u, Float v) {
  const Float3 d = Float3(light.center) - point;
  const Float distance2 = dot(d, d);
  const Float distance = sqrt(distance2);
  const Float spread = computeSpread(light, distance2);
  const Float fall = spread * u; // 1 - cos of the angle to the axis
  const Float cosine = 1.0F - fall;
  const Float sine2 = max(fall * (2.0F - fall), 0.0F);
  const Float sine = sqrt(sine2);
  const CosineSine phi = cosSinTurns(v);
  const LaneMask isSeparate = distance > 0.0F;
  const Float3 axis = select(isSeparate, (1.0F / distance) * d, Float3(0.0F, 0.0F, 1.0F));
  const Float3 local = Float3(sine * phi.cosine, sine * phi.sine, cosine);
  LightSamples samples;
  samples.direction = normalize(fromFrame(makeFrames(axis), local));
  samples.radiance = Float3(light.radiance);
  samples.distance = computeDistance(light, distance2, distance * cosine, distance2 * sine2);
  samples.pdf = computePdf(light, spread);
  samples.isDelta = noLanes();
  return samples;
}

/// The direction of the light: no random numbers are used.
FORMULA LightSamples sampleLight(STRUCT(PlacedDirectional) light, Float3, Float, Float) {
  LightSamples samples;
  samples.direction = Float3(light.toward);
  samples.radiance = Float3(light.irradiance);
  samples.distance = infiniteReal;
  samples.pdf = light.pmf;
  samples.isDelta = allLanes();
  return samples;
}

/// Lanes whose ray hits a light, and the light sampling density of the ray's direction there.
struct LightHits {
  LaneMask hit;
  Float pdf;
};

/// Intersects the rays of the lanes of `which` with a light, before `end` (mm).
FORMULA LightHits intersect(STRUCT(PlacedArea) light, LaneMask which, Float3 origin,
                            Float3 direction, Float end) {
  const Float3 normal = Float3(light.normal);
  const Float cosine = -dot(normal, direction);
  const Float t = dot(normal, origin - Float3(light.center)) / cosine;
  const LaneMask ahead = both(both(cosine > 0.0F, t > 0.0F), t < end);
  LightHits hits;
  hits.hit = both(which, ahead);
  hits.pdf = 0.0F;
  if (!isAny(hits.hit))
    return hits;
  const Float3 d = origin + t * direction - Float3(light.center);
  const Float x2 = square(dot(d, Float3(light.right)) * light.perRight);
  const Float y2 = square(dot(d, Float3(light.up)) * light.perUp);
  const Float r2 = light.isDisk ? x2 + y2 : max(x2, y2);
  hits.hit = both(hits.hit, r2 <= 1.0F);
  hits.pdf = light.pmf * square(t) / (light.area * cosine);
  return hits;
}

FORMULA LightHits intersect(STRUCT(PlacedSphere) light, LaneMask which, Float3 origin,
                            Float3 direction, Float end) {
  const Float3 d = Float3(light.center) - origin;
  const Float distance2 = dot(d, d);
  const Float along = dot(d, direction);
  const Float3 across = d - along * direction;
  const Float across2 = dot(across, across);
  const Float radius2 = light.radius2;
  const LaneMask ahead = both(along > 0.0F, across2 <= radius2);
  const Float far = computeDistance(light, distance2, along, across2);
  LightHits hits;
  hits.hit = both(both(which, either(distance2 <= radius2, ahead)), far < end);
  hits.pdf = 0.0F;
  if (isAny(hits.hit))
    hits.pdf = computePdf(light, computeSpread(light, distance2));
  return hits;
}

/// Adds a sky's radiance to `sum`.
FORMULA Float3 addSky(Float3 sum, STRUCT(PlacedSky) sky, Float3 direction) {
  const Float t = min(max(dot(Float3(sky.up), direction), -1.0F), 1.0F);
  const Float3 slope = select(t < 0.0F, Float3(sky.toBottom), Float3(sky.toTop));
  return sum + Float3(sky.middle) + abs(t) * slope;
}
