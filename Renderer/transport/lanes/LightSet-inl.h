// Lights for many paths: model/lights/LightSet.h in lanes. Compiled once for each instruction set
// (see PathSteps.cxx).

#if defined(FENESTRA_WIDE_LIGHTS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef FENESTRA_WIDE_LIGHTS_INL_H
#undef FENESTRA_WIDE_LIGHTS_INL_H
#else
#define FENESTRA_WIDE_LIGHTS_INL_H
#endif

#include "base/LaneMath-inl.h"
#include "transport/lanes/PathTables.h"

HWY_BEFORE_NAMESPACE();
namespace fenestra::HWY_NAMESPACE {

/// LightSample in lanes; radiance 0: no sample.
struct LightDraw {
  Float3 direction, radiance;
  Float distance;
  Float pdf;
  Mask delta;
};

class WideLights {
public:
  explicit HWY_INLINE WideLights(const EventScene& scene) : m_scene(scene) {}

  bool some() const {
    return !m_scene.areas.empty() || !m_scene.directionals.empty() || !m_scene.spheres.empty() ||
           m_scene.maps != nullptr;
  }

  /// Draws one light for each lane of `which`, seen from a local point. `choice` selects the light.
  LightDraw draw(Mask which, const Float3& point, Float choice, Float u, Float v) const {
    const Float zero = 0.0F;
    const Float far = std::numeric_limits<float>::infinity();
    LightDraw drawn{{zero, zero, 1.0F}, {zero, zero, zero}, far, 1.0F, Mask::none()};
    const auto chosen = [&](float share) {
      const Mask mine = which & (choice <= share);
      which = which.without(mine);
      choice = choice - share;
      return mine;
    };
    for (const EventScene::Area& light : m_scene.areas) {
      const Mask mine = chosen(light.share);
      if (mine.any())
        drawArea(light, mine, point, u, v, drawn);
    }
    for (const EventScene::Directional& light : m_scene.directionals) {
      const Mask mine = chosen(light.share);
      drawn.direction = select(mine, Float3(light.toward), drawn.direction);
      drawn.radiance = select(mine, Float3(light.irradiance), drawn.radiance);
      drawn.pdf = select(mine, light.share, drawn.pdf);
      drawn.delta = mine | drawn.delta;
    }
    for (const EventScene::Sphere& light : m_scene.spheres) {
      const Mask mine = chosen(light.share);
      if (mine.any())
        drawSphere(light, mine, point, u, v, drawn);
    }
    if (m_scene.maps && which.any())
      drawMaps(which, choice, u, v, drawn);
    return drawn;
  }

  /// Light that scattered rays from local points meet before `distance`, or at infinity, weighted
  /// against drawing that light (Veach 1997, eq. 9.8).
  Float3 arriving(Mask which, const Float3& origin, const Float3& direction, Float distance,
                  Float scatterPdf) const {
    const Float zero = 0.0F;
    Float3 sum{zero, zero, zero};
    for (const EventScene::Area& light : m_scene.areas)
      sum = sum + arrivingFrom(light, which, origin, direction, distance, scatterPdf);
    for (const EventScene::Sphere& light : m_scene.spheres)
      sum = sum + arrivingFrom(light, which, origin, direction, distance, scatterPdf);
    const Mask escaped = which & (distance == std::numeric_limits<float>::infinity());
    if (!m_scene.maps)
      return sum + orZero(escaped, around(direction));
    if (escaped.any())
      sum = sum + fromMaps(escaped, direction, scatterPdf);
    return sum;
  }

private:
  static HWY_INLINE void drawArea(const EventScene::Area& light, Mask mine, const Float3& point,
                                  Float u, Float v, LightDraw& drawn) {
    Float x = fms(2.0F, u, 1.0F);
    Float y = fms(2.0F, v, 1.0F);
    if (light.disk) {
      const CosineSine phi = ofTurns(v);
      const Float r = sqrt(u);
      x = r * phi.cosine;
      y = r * phi.sine;
    }
    const Float3 d = Float3(light.center) + x * Float3(light.right) + y * Float3(light.up) - point;
    const Float distance2 = dot(d, d);
    const Float distance = sqrt(distance2);
    const Float3 direction = (1.0F / distance) * d;
    const Float cosine = -dot(Float3(light.normal), direction);
    // False behind the light, in its plane, and on the light (NaN).
    const Mask lit = mine & (cosine > 0.0F);
    const Float pdf = light.share * distance2 / (light.area * cosine);
    drawn.direction = select(lit, direction, drawn.direction);
    drawn.radiance = select(lit, Float3(light.radiance), drawn.radiance);
    drawn.distance = select(lit, distance, drawn.distance);
    drawn.pdf = select(lit, pdf, drawn.pdf);
  }

  /// 1 - cos of half the angle that a sphere subtends; 2 from inside.
  static HWY_INLINE Float spreadOf(const EventScene::Sphere& light, Float distance2) {
    const Float one = 1.0F;
    const Float sine2 = light.radius2 / distance2;
    const Float cosine = sqrt(max(one - sine2, 0.0F));
    return select(sine2 < one, sine2 / (one + cosine), 2.0F);
  }
  static HWY_INLINE Float densityOf(const EventScene::Sphere& light, Float spread) {
    return light.share / (narrow(2.0 * pi) * spread);
  }
  /// Distance to a sphere whose centre is `along` ahead, and aside by the square root of `across2`.
  static HWY_INLINE Float distanceTo(const EventScene::Sphere& light, Float distance2, Float along,
                                     Float across2) {
    const Float zero = 0.0F;
    const Float outside = distance2 - light.radius2;
    const Float half = sqrt(max(light.radius2 - across2, zero));
    const Float far = along + half;
    return select(outside > zero, outside / far, far);
  }

  static HWY_INLINE void drawSphere(const EventScene::Sphere& light, Mask mine, const Float3& point,
                                    Float u, Float v, LightDraw& drawn) {
    const Float zero = 0.0F, one = 1.0F;
    const Float3 d = Float3(light.center) - point;
    const Float distance2 = dot(d, d);
    const Float distance = sqrt(distance2);
    const Float spread = spreadOf(light, distance2);
    const Float fall = spread * u; // 1 - cos of the angle to the axis
    const Float cosine = one - fall;
    const Float sine2 = max(fall * (2.0F - fall), zero);
    const Float sine = sqrt(sine2);
    const CosineSine phi = ofTurns(v);
    const Mask apart = distance > zero;
    const Float3 axis = select(apart, (one / distance) * d, Float3{zero, zero, one});
    const Float3 local{sine * phi.cosine, sine * phi.sine, cosine};
    const Float far = distanceTo(light, distance2, distance * cosine, distance2 * sine2);
    drawn.direction = select(mine, normalized(Frames(axis).toWorld(local)), drawn.direction);
    drawn.radiance = select(mine, Float3(light.radiance), drawn.radiance);
    drawn.distance = select(mine, far, drawn.distance);
    drawn.pdf = select(mine, densityOf(light, spread), drawn.pdf);
  }

  void drawMaps(Mask which, Float choice, Float u, Float v, LightDraw& drawn) const {
    const LaneArray<float> choices(choice), us(u), vs(v);
    LaneArray<float> direction[3] = {LaneArray<float>(drawn.direction.x),
                                     LaneArray<float>(drawn.direction.y),
                                     LaneArray<float>(drawn.direction.z)};
    LaneArray<float> radiance[3] = {LaneArray<float>(drawn.radiance.x),
                                    LaneArray<float>(drawn.radiance.y),
                                    LaneArray<float>(drawn.radiance.z)};
    LaneArray<float> pdf(drawn.pdf);
    forEachLane(which, [&](std::size_t lane) {
      const auto number = [&](const LaneArray<float>& x) { return static_cast<double>(x[lane]); };
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
    drawn.direction = {load(direction[0].data()), load(direction[1].data()),
                       load(direction[2].data())};
    drawn.radiance = {load(radiance[0].data()), load(radiance[1].data()), load(radiance[2].data())};
    drawn.pdf = load(pdf.data());
  }

  /// Radiance of constant environments and skies.
  HWY_INLINE Float3 around(const Float3& direction) const {
    const Float zero = 0.0F, one = 1.0F;
    Float3 sum = Float3(m_scene.constantEnvironment);
    for (const EventScene::Sky& sky : m_scene.skies) {
      const Float t = min(max(dot(Float3(sky.up), direction), -one), one);
      const Float3 slope = select(t < zero, Float3(sky.toBottom), Float3(sky.toTop));
      sum = sum + Float3(sky.middle) + abs(t) * slope;
    }
    return sum;
  }

  static HWY_INLINE Float3 weighted(Mask met, Float scatterPdf, Float pdf,
                                    const EventScene::Triple& radiance) {
    const Float weight = scatterPdf / (scatterPdf + pdf);
    return orZero(met, weight * Float3(radiance));
  }

  static HWY_INLINE Float3 arrivingFrom(const EventScene::Area& light, Mask which,
                                        const Float3& origin, const Float3& direction,
                                        Float distance, Float scatterPdf) {
    const Float zero = 0.0F;
    const Float3 normal = Float3(light.normal);
    const Float cosine = -dot(normal, direction);
    const Float t = dot(normal, origin - Float3(light.center)) / cosine;
    const Mask ahead = (cosine > zero) & (t > zero) & (t < distance);
    Mask met = which & ahead;
    if (!met.any())
      return {zero, zero, zero};
    const Float3 d = origin + t * direction - Float3(light.center);
    const Float x2 = square(dot(d, Float3(light.right)) * light.perRight);
    const Float y2 = square(dot(d, Float3(light.up)) * light.perUp);
    const Float one = 1.0F;
    met = met & ((light.disk ? x2 + y2 : max(x2, y2)) <= one);
    const Float pdf = light.share * square(t) / (light.area * cosine);
    return weighted(met, scatterPdf, pdf, light.radiance);
  }

  static HWY_INLINE Float3 arrivingFrom(const EventScene::Sphere& light, Mask which,
                                        const Float3& origin, const Float3& direction,
                                        Float distance, Float scatterPdf) {
    const Float zero = 0.0F;
    const Float3 d = Float3(light.center) - origin;
    const Float distance2 = dot(d, d);
    const Float along = dot(d, direction);
    const Float3 across = d - along * direction;
    const Float across2 = dot(across, across);
    const Float radius2 = light.radius2;
    const Mask ahead = (along > zero) & (across2 <= radius2);
    const Mask hits = (distance2 <= radius2) | ahead;
    const Float far = distanceTo(light, distance2, along, across2);
    const Mask met = which & hits & (far < distance);
    if (!met.any())
      return {zero, zero, zero};
    const Float pdf = densityOf(light, spreadOf(light, distance2));
    return weighted(met, scatterPdf, pdf, light.radiance);
  }

  Float3 fromMaps(Mask escaped, const Float3& direction, Float scatterPdf) const {
    const Float zero = 0.0F;
    const LaneArray<float> x(direction.x), y(direction.y), z(direction.z), pdf(scatterPdf);
    LaneArray<float> r(zero), g(zero), b(zero);
    forEachLane(escaped, [&](std::size_t lane) {
      const auto number = [&](const LaneArray<float>& v) { return static_cast<double>(v[lane]); };
      const LightArrival arrival = m_scene.maps->environment({number(x), number(y), number(z)});
      const Rgb sum = arrival.radiance * (number(pdf) / (number(pdf) + arrival.pdf));
      r[lane] = narrow(sum[0]);
      g[lane] = narrow(sum[1]);
      b[lane] = narrow(sum[2]);
    });
    return {load(r.data()), load(g.data()), load(b.data())};
  }

  const EventScene& m_scene;
};

} // namespace fenestra::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
