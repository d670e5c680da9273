// Lights for many paths: model/lights/LightSet.h in lanes. Compiled once for each instruction set
// (see PathSteps.cxx).

#if defined(FENESTRA_WIDE_LIGHTS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef FENESTRA_WIDE_LIGHTS_INL_H
#undef FENESTRA_WIDE_LIGHTS_INL_H
#else
#define FENESTRA_WIDE_LIGHTS_INL_H
#endif

#include "base/Lanes-inl.h"
#include "transport/lanes/PathTables.h"

HWY_BEFORE_NAMESPACE();
namespace fenestra::HWY_NAMESPACE {

/// LightSample in lanes; radiance 0: no sample.
struct LightDraw {
  F3 direction, radiance;
  F distance;
  F pdf;
  M delta;
};

/// One number a lane, in memory, for work lane by lane.
struct alignas(64) LaneNumbers : std::array<float, HWY_MAX_BYTES / sizeof(float)> {
  LaneNumbers() = default;
  explicit LaneNumbers(F v) { hn::Store(v, floats, data()); }
  F vector() const { return hn::Load(floats, data()); }
};

class WideLights {
public:
  explicit HWY_INLINE WideLights(const EventScene& scene) : m_scene(scene) {}

  bool some() const {
    return !m_scene.areas.empty() || !m_scene.directionals.empty() || !m_scene.spheres.empty() ||
           m_scene.maps != nullptr;
  }

  /// Draws one light for each lane of `which`, seen from a local point. `choice` selects the light.
  LightDraw draw(M which, const F3& point, F choice, F u, F v) const {
    const F zero = hn::Zero(floats);
    const F far = all(std::numeric_limits<float>::infinity());
    LightDraw drawn{{zero, zero, all(1.0F)}, {zero, zero, zero}, far, all(1.0F), noLane()};
    const auto chosen = [&](float share) {
      const M mine = both(which, hn::Le(choice, all(share)));
      which = hn::AndNot(mine, which);
      choice = hn::Sub(choice, all(share));
      return mine;
    };
    for (const EventScene::Area& light : m_scene.areas) {
      const M mine = chosen(light.share);
      if (!hn::AllFalse(floats, mine))
        drawArea(light, mine, point, u, v, drawn);
    }
    for (const EventScene::Directional& light : m_scene.directionals) {
      const M mine = chosen(light.share);
      drawn.direction = select(mine, all3(light.toward), drawn.direction);
      drawn.radiance = select(mine, all3(light.irradiance), drawn.radiance);
      drawn.pdf = hn::IfThenElse(mine, all(light.share), drawn.pdf);
      drawn.delta = hn::Or(mine, drawn.delta);
    }
    for (const EventScene::Sphere& light : m_scene.spheres) {
      const M mine = chosen(light.share);
      if (!hn::AllFalse(floats, mine))
        drawSphere(light, mine, point, u, v, drawn);
    }
    if (m_scene.maps && !hn::AllFalse(floats, which))
      drawMaps(which, choice, u, v, drawn);
    return drawn;
  }

  /// Light that scattered rays from local points meet before `distance`, or at infinity, weighted
  /// against drawing that light (Veach 1997, eq. 9.8).
  F3 arriving(M which, const F3& origin, const F3& direction, F distance, F scatterPdf) const {
    const F zero = hn::Zero(floats);
    F3 sum{zero, zero, zero};
    for (const EventScene::Area& light : m_scene.areas)
      sum = sum + arrivingFrom(light, which, origin, direction, distance, scatterPdf);
    for (const EventScene::Sphere& light : m_scene.spheres)
      sum = sum + arrivingFrom(light, which, origin, direction, distance, scatterPdf);
    const M escaped = both(which, hn::Eq(distance, all(std::numeric_limits<float>::infinity())));
    if (!m_scene.maps)
      return sum + selectElseZero(escaped, around(direction));
    if (!hn::AllFalse(floats, escaped))
      sum = sum + fromMaps(escaped, direction, scatterPdf);
    return sum;
  }

private:
  static HWY_INLINE void drawArea(const EventScene::Area& light, M mine, const F3& point, F u, F v,
                                  LightDraw& drawn) {
    F x = hn::MulSub(all(2.0F), u, all(1.0F));
    F y = hn::MulSub(all(2.0F), v, all(1.0F));
    if (light.disk) {
      const CosineSine phi = ofTurns(v);
      const F r = hn::Sqrt(u);
      x = hn::Mul(r, phi.cosine);
      y = hn::Mul(r, phi.sine);
    }
    const F3 d = all3(light.center) + x * all3(light.right) + y * all3(light.up) - point;
    const F distance2 = dot(d, d);
    const F distance = hn::Sqrt(distance2);
    const F3 direction = hn::Div(all(1.0F), distance) * d;
    const F cosine = hn::Neg(dot(all3(light.normal), direction));
    // False behind the light, in its plane, and on the light (NaN).
    const M lit = both(mine, hn::Gt(cosine, hn::Zero(floats)));
    const F pdf = hn::Div(hn::Mul(all(light.share), distance2), hn::Mul(all(light.area), cosine));
    drawn.direction = select(lit, direction, drawn.direction);
    drawn.radiance = select(lit, all3(light.radiance), drawn.radiance);
    drawn.distance = hn::IfThenElse(lit, distance, drawn.distance);
    drawn.pdf = hn::IfThenElse(lit, pdf, drawn.pdf);
  }

  /// 1 - cos of half the angle that a sphere subtends; 2 from inside.
  static HWY_INLINE F spreadOf(const EventScene::Sphere& light, F distance2) {
    const F one = all(1.0F);
    const F sine2 = hn::Div(all(light.radius2), distance2);
    const F cosine = hn::Sqrt(hn::Max(hn::Sub(one, sine2), hn::Zero(floats)));
    return hn::IfThenElse(hn::Lt(sine2, one), hn::Div(sine2, hn::Add(one, cosine)), all(2.0F));
  }
  static HWY_INLINE F densityOf(const EventScene::Sphere& light, F spread) {
    return hn::Div(all(light.share), hn::Mul(all(narrow(2.0 * pi)), spread));
  }
  /// Distance to a sphere whose centre is `along` ahead, and aside by the square root of `across2`.
  static HWY_INLINE F distanceTo(const EventScene::Sphere& light, F distance2, F along, F across2) {
    const F zero = hn::Zero(floats);
    const F outside = hn::Sub(distance2, all(light.radius2));
    const F half = hn::Sqrt(hn::Max(hn::Sub(all(light.radius2), across2), zero));
    const F far = hn::Add(along, half);
    return hn::IfThenElse(hn::Gt(outside, zero), hn::Div(outside, far), far);
  }

  static HWY_INLINE void drawSphere(const EventScene::Sphere& light, M mine, const F3& point, F u,
                                    F v, LightDraw& drawn) {
    const F zero = hn::Zero(floats), one = all(1.0F);
    const F3 d = all3(light.center) - point;
    const F distance2 = dot(d, d);
    const F distance = hn::Sqrt(distance2);
    const F spread = spreadOf(light, distance2);
    const F fall = hn::Mul(spread, u); // 1 - cos of the angle to the axis
    const F cosine = hn::Sub(one, fall);
    const F sine2 = hn::Max(hn::Mul(fall, hn::Sub(all(2.0F), fall)), zero);
    const F sine = hn::Sqrt(sine2);
    const CosineSine phi = ofTurns(v);
    const M apart = hn::Gt(distance, zero);
    const F3 axis = select(apart, hn::Div(one, distance) * d, F3{zero, zero, one});
    const F3 local{hn::Mul(sine, phi.cosine), hn::Mul(sine, phi.sine), cosine};
    const F far =
        distanceTo(light, distance2, hn::Mul(distance, cosine), hn::Mul(distance2, sine2));
    drawn.direction = select(mine, normalized(Frames(axis).toWorld(local)), drawn.direction);
    drawn.radiance = select(mine, all3(light.radiance), drawn.radiance);
    drawn.distance = hn::IfThenElse(mine, far, drawn.distance);
    drawn.pdf = hn::IfThenElse(mine, densityOf(light, spread), drawn.pdf);
  }

  void drawMaps(M which, F choice, F u, F v, LightDraw& drawn) const {
    const LaneNumbers choices(choice), us(u), vs(v);
    LaneNumbers direction[3] = {LaneNumbers(drawn.direction.x), LaneNumbers(drawn.direction.y),
                                LaneNumbers(drawn.direction.z)};
    LaneNumbers radiance[3] = {LaneNumbers(drawn.radiance.x), LaneNumbers(drawn.radiance.y),
                               LaneNumbers(drawn.radiance.z)};
    LaneNumbers pdf(drawn.pdf);
    forEachLane(which, [&](std::size_t lane) {
      const auto number = [&](const LaneNumbers& x) { return static_cast<double>(x[lane]); };
      const std::optional<LightSample> light =
          m_scene.maps->sampleEnvironment(number(choices), {number(us), number(vs)});
      if (!light)
        return;
      for (int axis = 0; axis < 3; ++axis) {
        direction[axis][lane] = narrow(light->direction[axis]);
        radiance[axis][lane] = narrow(light->radiance[axis]);
      }
      pdf[lane] = narrow(light->pdf);
    });
    drawn.direction = {direction[0].vector(), direction[1].vector(), direction[2].vector()};
    drawn.radiance = {radiance[0].vector(), radiance[1].vector(), radiance[2].vector()};
    drawn.pdf = pdf.vector();
  }

  /// Radiance of constant environments and skies.
  HWY_INLINE F3 around(const F3& direction) const {
    const F zero = hn::Zero(floats), one = all(1.0F);
    F3 sum = all3(m_scene.constantEnvironment);
    for (const EventScene::Sky& sky : m_scene.skies) {
      const F t = hn::Min(hn::Max(dot(all3(sky.up), direction), hn::Neg(one)), one);
      const F3 slope = select(hn::Lt(t, zero), all3(sky.toBottom), all3(sky.toTop));
      sum = sum + all3(sky.middle) + hn::Abs(t) * slope;
    }
    return sum;
  }

  static HWY_INLINE F3 weighted(M met, F scatterPdf, F pdf, const EventScene::Triple& radiance) {
    const F weight = hn::Div(scatterPdf, hn::Add(scatterPdf, pdf));
    return selectElseZero(met, weight * all3(radiance));
  }

  static HWY_INLINE F3 arrivingFrom(const EventScene::Area& light, M which, const F3& origin,
                                    const F3& direction, F distance, F scatterPdf) {
    const F zero = hn::Zero(floats);
    const F3 normal = all3(light.normal);
    const F cosine = hn::Neg(dot(normal, direction));
    const F t = hn::Div(dot(normal, origin - all3(light.center)), cosine);
    const M ahead = both(hn::Gt(cosine, zero), both(hn::Gt(t, zero), hn::Lt(t, distance)));
    M met = both(which, ahead);
    if (hn::AllFalse(floats, met))
      return {zero, zero, zero};
    const F3 d = origin + t * direction - all3(light.center);
    const F x2 = square(hn::Mul(dot(d, all3(light.right)), all(light.perRight)));
    const F y2 = square(hn::Mul(dot(d, all3(light.up)), all(light.perUp)));
    const F one = all(1.0F);
    met = both(met, hn::Le(light.disk ? hn::Add(x2, y2) : hn::Max(x2, y2), one));
    const F pdf = hn::Div(hn::Mul(all(light.share), square(t)), hn::Mul(all(light.area), cosine));
    return weighted(met, scatterPdf, pdf, light.radiance);
  }

  static HWY_INLINE F3 arrivingFrom(const EventScene::Sphere& light, M which, const F3& origin,
                                    const F3& direction, F distance, F scatterPdf) {
    const F zero = hn::Zero(floats);
    const F3 d = all3(light.center) - origin;
    const F distance2 = dot(d, d);
    const F along = dot(d, direction);
    const F3 across = d - along * direction;
    const F across2 = dot(across, across);
    const F radius2 = all(light.radius2);
    const M ahead = both(hn::Gt(along, zero), hn::Le(across2, radius2));
    const M hits = hn::Or(hn::Le(distance2, radius2), ahead);
    const F far = distanceTo(light, distance2, along, across2);
    const M met = both(which, both(hits, hn::Lt(far, distance)));
    if (hn::AllFalse(floats, met))
      return {zero, zero, zero};
    const F pdf = densityOf(light, spreadOf(light, distance2));
    return weighted(met, scatterPdf, pdf, light.radiance);
  }

  F3 fromMaps(M escaped, const F3& direction, F scatterPdf) const {
    const F zero = hn::Zero(floats);
    const LaneNumbers x(direction.x), y(direction.y), z(direction.z), pdf(scatterPdf);
    LaneNumbers r(zero), g(zero), b(zero);
    forEachLane(escaped, [&](std::size_t lane) {
      const auto number = [&](const LaneNumbers& v) { return static_cast<double>(v[lane]); };
      const LightArrival arrival = m_scene.maps->environment({number(x), number(y), number(z)});
      const Rgb sum = arrival.radiance * (number(pdf) / (number(pdf) + arrival.pdf));
      r[lane] = narrow(sum[0]);
      g[lane] = narrow(sum[1]);
      b[lane] = narrow(sum[2]);
    });
    return {r.vector(), g.vector(), b.vector()};
  }

  const EventScene& m_scene;
};

} // namespace fenestra::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
