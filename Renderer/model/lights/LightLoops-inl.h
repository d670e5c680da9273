// Loops over the lights of a scene, for scalar and SIMD code. Include after
// model/lights/LightTables.h, inside the namespace that defines Float (base/ScalarMath.h).

using Lights = LightTables<Real>;
using PlacedArea = Lights::PlacedArea;
using PlacedSphere = Lights::PlacedSphere;
using PlacedDirectional = Lights::PlacedDirectional;
using PlacedSky = Lights::PlacedSky;
#include "formulas/Lights.inl"

FORMULA LightSamples select(LaneMask which, const LightSamples& yes, const LightSamples& no) {
  return {select(which, yes.direction, no.direction), select(which, yes.radiance, no.radiance),
          select(which, yes.distance, no.distance), select(which, yes.pdf, no.pdf),
          either(both(which, yes.isDelta), without(no.isDelta, which))};
}

/// Samples one light per lane of `which`, as seen from `point`; `choice` selects it by the lights'
/// pmf. On return, the remaining `which` and `choice` select among environment maps.
FORMULA LightSamples sampleLights(const Lights& lights, LaneMask& which, const Float3& point,
                                  Float& choice, Float u, Float v) {
  LightSamples samples{{0.0F, 0.0F, 1.0F}, {0.0F, 0.0F, 0.0F}, infiniteReal, 1.0F, noLanes()};
  const auto choose = [&](Real pmf) {
    const LaneMask mine = both(which, sampleBernoulli(pmf, choice));
    which = without(which, mine);
    choice = choice - pmf;
    return mine;
  };
  const auto sampleEach = [&](const auto& list) {
    for (const auto& light : list)
      if (const LaneMask mine = choose(light.pmf); isAny(mine))
        samples = select(mine, sampleLight(light, point, u, v), samples);
  };
  sampleEach(lights.areas);
  sampleEach(lights.directionals);
  sampleEach(lights.spheres);
  return samples;
}

/// Calls visit(lanes, radiance, pdf) for each area light and sphere that rays of the lanes of
/// `which` hit before `end` (mm).
template <typename Visit>
FORMULA void intersectLights(const Lights& lights, LaneMask which, const Float3& origin,
                             const Float3& direction, Float end, Visit&& visit) {
  const auto intersectEach = [&](const auto& list) {
    for (const auto& light : list)
      if (const LightHits at = intersect(light, which, origin, direction, end); isAny(at.hit))
        visit(at.hit, Float3(light.radiance), at.pdf);
  };
  intersectEach(lights.areas);
  intersectEach(lights.spheres);
}

/// Total radiance of the constant environments and the skies.
FORMULA Float3 evaluateSkies(const Lights& lights, const Float3& direction) {
  Float3 sum = Float3(lights.constant);
  for (const PlacedSky& sky : lights.skies)
    sum = addSky(sum, sky, direction);
  return sum;
}
