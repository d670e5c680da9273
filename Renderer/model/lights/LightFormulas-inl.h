// Sampling and intersection formulas for lights, written once for scalar and SIMD code. Include
// after model/lights/LightTables.h, inside the namespace that defines Float (base/ScalarMath.h).

using Lights = LightTables<Real>;

/// LightSample in each lane; radiance 0 marks an invalid sample.
struct LightSamples {
  Float3 direction, radiance;
  Float distance;
  Float pdf;
  LaneMask isDelta;
};

/// Samples a point on the light, as seen from `point`, in the lanes of `mine`.
FENESTRA_INLINE void samplePoint(const Lights::Area& light, LaneMask mine, const Float3& point,
                                 Float u, Float v, LightSamples& samples) {
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
  const LaneMask isSeparate = distance2 >= std::numeric_limits<Real>::min();
  const LaneMask lit = mine & isSeparate & (cosine > 0.0F);
  const Float pdf = light.pmf * distance2 / (light.area * cosine);
  samples.direction = select(lit, direction, samples.direction);
  samples.radiance = select(lit, Float3(light.radiance), samples.radiance);
  samples.distance = select(lit, distance, samples.distance);
  samples.pdf = select(lit, pdf, samples.pdf);
}

/// 1 - cos of half the angle that a sphere subtends, as sin^2 / (1 + cos), which is accurate for
/// narrow cones; 2 from inside: all directions. The solid angle is 2 pi times that.
FENESTRA_INLINE Float computeSpread(const Lights::Sphere& light, Float distance2) {
  const Float sine2 = light.radius2 / distance2; // 0 / 0 = NaN at the center of a tiny sphere
  const Float cosine = sqrt(max(1.0F - sine2, 0.0F));
  return select(sine2 < 1.0F, sine2 / (1.0F + cosine), 2.0F);
}
FENESTRA_INLINE Float computePdf(const Lights::Sphere& light, Float spread) {
  return light.pmf / (static_cast<Real>(2.0 * pi) * spread);
}
/// Distance along a ray to a sphere. The ray passes the center after the length `along`, at the
/// squared distance `across2`.
FENESTRA_INLINE Float computeDistance(const Lights::Sphere& light, Float distance2, Float along,
                                      Float across2) {
  const Float outside = distance2 - light.radius2;
  const Float half = sqrt(max(light.radius2 - across2, 0.0F)); // half chord
  const Float far = along + half;
  return select(outside > 0.0F, outside / far, far); // outside = near * far
}

/// Samples a direction in the cone that the sphere subtends at `point`, in the lanes of `mine`.
FENESTRA_INLINE void samplePoint(const Lights::Sphere& light, LaneMask mine, const Float3& point,
                                 Float u, Float v, LightSamples& samples) {
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
  const Float3 axis = select(isSeparate, (1.0F / distance) * d, Float3{0.0F, 0.0F, 1.0F});
  const Float3 local{sine * phi.cosine, sine * phi.sine, cosine};
  const Float far = computeDistance(light, distance2, distance * cosine, distance2 * sine2);
  samples.direction = select(mine, normalize(Frames(axis).toWorld(local)), samples.direction);
  samples.radiance = select(mine, Float3(light.radiance), samples.radiance);
  samples.distance = select(mine, far, samples.distance);
  samples.pdf = select(mine, computePdf(light, spread), samples.pdf);
}

/// Samples one light per lane of `which`, as seen from `point`; `choice` selects it by the lights'
/// pmf. On return, the remaining `which` and `choice` select among environment maps.
FENESTRA_INLINE LightSamples sampleLights(const Lights& lights, LaneMask& which,
                                          const Float3& point, Float& choice, Float u, Float v) {
  const Float far = std::numeric_limits<Real>::infinity();
  LightSamples samples{{0.0F, 0.0F, 1.0F}, {0.0F, 0.0F, 0.0F}, far, 1.0F, LaneMask::none()};
  const auto choose = [&](Real pmf) {
    const LaneMask mine = which & sampleBernoulli(pmf, choice);
    which = which.without(mine);
    choice = choice - pmf;
    return mine;
  };
  for (const Lights::Area& light : lights.areas) {
    const LaneMask mine = choose(light.pmf);
    if (mine.any())
      samplePoint(light, mine, point, u, v, samples);
  }
  for (const Lights::Directional& light : lights.directionals) {
    const LaneMask mine = choose(light.pmf);
    samples.direction = select(mine, Float3(light.toward), samples.direction);
    samples.radiance = select(mine, Float3(light.irradiance), samples.radiance);
    samples.pdf = select(mine, light.pmf, samples.pdf);
    samples.isDelta = mine | samples.isDelta;
  }
  for (const Lights::Sphere& light : lights.spheres) {
    const LaneMask mine = choose(light.pmf);
    if (mine.any())
      samplePoint(light, mine, point, u, v, samples);
  }
  return samples;
}

/// Lanes whose ray hits a light, and the light sampling density of the ray's direction there.
struct LightHits {
  LaneMask hit;
  Float pdf;
};

/// Intersects the rays of the lanes of `which` with a light, before `end` (mm).
FENESTRA_INLINE LightHits intersect(const Lights::Area& light, LaneMask which, const Float3& origin,
                                    const Float3& direction, Float end) {
  const Float3 normal = Float3(light.normal);
  const Float cosine = -dot(normal, direction);
  const Float t = dot(normal, origin - Float3(light.center)) / cosine;
  const LaneMask ahead = (cosine > 0.0F) & (t > 0.0F) & (t < end);
  const LaneMask hit = which & ahead;
  if (!hit.any())
    return {hit, 0.0F};
  const Float3 d = origin + t * direction - Float3(light.center);
  const Float x2 = square(dot(d, Float3(light.right)) * light.perRight);
  const Float y2 = square(dot(d, Float3(light.up)) * light.perUp);
  const LaneMask inside = (light.isDisk ? x2 + y2 : max(x2, y2)) <= 1.0F;
  return {hit & inside, light.pmf * square(t) / (light.area * cosine)};
}

FENESTRA_INLINE LightHits intersect(const Lights::Sphere& light, LaneMask which,
                                    const Float3& origin, const Float3& direction, Float end) {
  const Float3 d = Float3(light.center) - origin;
  const Float distance2 = dot(d, d);
  const Float along = dot(d, direction);
  const Float3 across = d - along * direction;
  const Float across2 = dot(across, across);
  const Float radius2 = light.radius2;
  const LaneMask ahead = (along > 0.0F) & (across2 <= radius2);
  const LaneMask hits = LaneMask(distance2 <= radius2) | ahead;
  const Float far = computeDistance(light, distance2, along, across2);
  const LaneMask hit = which & hits & (far < end);
  if (!hit.any())
    return {hit, 0.0F};
  return {hit, computePdf(light, computeSpread(light, distance2))};
}

/// Calls visit(lanes, radiance, pdf) for each area light and sphere that rays of the lanes of
/// `which` hit before `end` (mm).
template <typename Visit>
FENESTRA_INLINE void intersectLights(const Lights& lights, LaneMask which, const Float3& origin,
                                     const Float3& direction, Float end, Visit&& visit) {
  const auto intersectOne = [&](const auto& light) {
    const LightHits at = intersect(light, which, origin, direction, end);
    if (at.hit.any())
      visit(at.hit, Float3(light.radiance), at.pdf);
  };
  for (const Lights::Area& light : lights.areas)
    intersectOne(light);
  for (const Lights::Sphere& light : lights.spheres)
    intersectOne(light);
}

/// Total radiance of the constant environments and the skies.
FENESTRA_INLINE Float3 evaluateSkies(const Lights& lights, const Float3& direction) {
  Float3 sum = Float3(lights.constant);
  for (const Lights::Sky& sky : lights.skies) {
    const Float t = min(max(dot(Float3(sky.up), direction), -1.0F), 1.0F);
    const Float3 slope = select(t < 0.0F, Float3(sky.toBottom), Float3(sky.toTop));
    sum = sum + Float3(sky.middle) + abs(t) * slope;
  }
  return sum;
}
