// Lights for many paths: model/lights/LightSet.h in lanes. Compiled once for each instruction set
// (see PathSteps.cxx).

#if defined(FENESTRA_WIDE_LIGHTS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef FENESTRA_WIDE_LIGHTS_INL_H
#undef FENESTRA_WIDE_LIGHTS_INL_H
#else
#define FENESTRA_WIDE_LIGHTS_INL_H
#endif

#include "base/LaneMath-inl.h"
#include "transport/lanes/EnvironmentSampler-inl.h"
#include "transport/lanes/PathTables.h"

HWY_BEFORE_NAMESPACE();
namespace fenestra::HWY_NAMESPACE {

/// LightSample in lanes; radiance 0: no sample.
struct LightDraw {
  Float3 direction, radiance;
  Float distance;
  Float pdf;
  LaneMask delta;
};

class WideLights {
public:
  explicit HWY_INLINE WideLights(const EventScene& scene) : m_scene(scene) {}

  bool some() const {
    return !m_scene.areas.empty() || !m_scene.directionals.empty() || !m_scene.spheres.empty() ||
           !m_scene.maps.empty();
  }

  /// Draws one light for each lane of `which`, seen from a local point. `choice` selects the
  /// light; `uBits`, `vBits`: random bits.
  LightDraw draw(LaneMask which, const Float3& point, Float choice, Word uBits, Word vBits) const {
    const Float u = uniformOf(uBits), v = uniformOf(vBits);
    const Float far = std::numeric_limits<float>::infinity();
    LightDraw drawn{{0.0F, 0.0F, 1.0F}, {0.0F, 0.0F, 0.0F}, far, 1.0F, LaneMask::none()};
    const auto chosen = [&](float share) {
      const LaneMask mine = which & (choice <= share);
      which = which.without(mine);
      choice = choice - share;
      return mine;
    };
    for (const EventScene::Area& light : m_scene.areas) {
      const LaneMask mine = chosen(light.share);
      if (mine.any())
        drawArea(light, mine, point, u, v, drawn);
    }
    for (const EventScene::Directional& light : m_scene.directionals) {
      const LaneMask mine = chosen(light.share);
      drawn.direction = select(mine, Float3(light.toward), drawn.direction);
      drawn.radiance = select(mine, Float3(light.irradiance), drawn.radiance);
      drawn.pdf = select(mine, light.share, drawn.pdf);
      drawn.delta = mine | drawn.delta;
    }
    for (const EventScene::Sphere& light : m_scene.spheres) {
      const LaneMask mine = chosen(light.share);
      if (mine.any())
        drawSphere(light, mine, point, u, v, drawn);
    }
    if (!m_scene.maps.empty() && which.any())
      drawMaps(which, choice, uBits, vBits, drawn);
    return drawn;
  }

  /// Light that scattered rays from local points meet before `distance`, or at infinity, weighted
  /// against drawing that light (Veach 1997, eq. 9.8).
  Float3 arriving(LaneMask which, const Float3& origin, const Float3& direction, Float distance,
                  Float scatterPdf) const {
    Float3 sum{0.0F, 0.0F, 0.0F};
    for (const EventScene::Area& light : m_scene.areas)
      sum = sum + arrivingFrom(light, which, origin, direction, distance, scatterPdf);
    for (const EventScene::Sphere& light : m_scene.spheres)
      sum = sum + arrivingFrom(light, which, origin, direction, distance, scatterPdf);
    const LaneMask escaped = which & (distance == std::numeric_limits<float>::infinity());
    if (m_scene.maps.empty())
      return sum + orZero(escaped, around(direction));
    if (!escaped.any())
      return sum;
    const Arrival far =
        around(direction, [&](const WideMap& map) { return map.texelToward(direction); });
    const Float weight = scatterPdf / (scatterPdf + far.pdf);
    return sum + orZero(escaped, weight * far.radiance);
  }

private:
  static HWY_INLINE void drawArea(const EventScene::Area& light, LaneMask mine, const Float3& point,
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
    const LaneMask lit = mine & (cosine > 0.0F);
    const Float pdf = light.share * distance2 / (light.area * cosine);
    drawn.direction = select(lit, direction, drawn.direction);
    drawn.radiance = select(lit, Float3(light.radiance), drawn.radiance);
    drawn.distance = select(lit, distance, drawn.distance);
    drawn.pdf = select(lit, pdf, drawn.pdf);
  }

  /// 1 - cos of half the angle that a sphere subtends; 2 from inside.
  static HWY_INLINE Float spreadOf(const EventScene::Sphere& light, Float distance2) {
    const Float sine2 = light.radius2 / distance2;
    const Float cosine = sqrt(max(1.0F - sine2, 0.0F));
    return select(sine2 < 1.0F, sine2 / (1.0F + cosine), 2.0F);
  }
  static HWY_INLINE Float densityOf(const EventScene::Sphere& light, Float spread) {
    return light.share / (narrow(2.0 * pi) * spread);
  }
  /// Distance to a sphere whose centre is `along` ahead, and aside by the square root of `across2`.
  static HWY_INLINE Float distanceTo(const EventScene::Sphere& light, Float distance2, Float along,
                                     Float across2) {
    const Float outside = distance2 - light.radius2;
    const Float half = sqrt(max(light.radius2 - across2, 0.0F));
    const Float far = along + half;
    return select(outside > 0.0F, outside / far, far);
  }

  static HWY_INLINE void drawSphere(const EventScene::Sphere& light, LaneMask mine,
                                    const Float3& point, Float u, Float v, LightDraw& drawn) {
    const Float3 d = Float3(light.center) - point;
    const Float distance2 = dot(d, d);
    const Float distance = sqrt(distance2);
    const Float spread = spreadOf(light, distance2);
    const Float fall = spread * u; // 1 - cos of the angle to the axis
    const Float cosine = 1.0F - fall;
    const Float sine2 = max(fall * (2.0F - fall), 0.0F);
    const Float sine = sqrt(sine2);
    const CosineSine phi = ofTurns(v);
    const LaneMask apart = distance > 0.0F;
    const Float3 axis = select(apart, (1.0F / distance) * d, Float3{0.0F, 0.0F, 1.0F});
    const Float3 local{sine * phi.cosine, sine * phi.sine, cosine};
    const Float far = distanceTo(light, distance2, distance * cosine, distance2 * sine2);
    drawn.direction = select(mine, normalized(Frames(axis).toWorld(local)), drawn.direction);
    drawn.radiance = select(mine, Float3(light.radiance), drawn.radiance);
    drawn.distance = select(mine, far, drawn.distance);
    drawn.pdf = select(mine, densityOf(light, spread), drawn.pdf);
  }

  void drawMaps(LaneMask which, Float choice, Word u, Word v, LightDraw& drawn) const {
    const std::size_t count = m_scene.maps.size();
    WideMap::Drawn toward = WideMap(m_scene.maps[0]).draw(u, v);
    LaneMask later = which;
    for (std::size_t i = 1; i < count; ++i) { // the last map takes the remainder of rounding
      const float before = m_scene.maps[i - 1].share;
      later = later & (choice > before);
      choice = choice - before;
      if (later.any())
        toward.direction =
            select(later, WideMap(m_scene.maps[i]).draw(u, v).direction, toward.direction);
    }
    const Arrival light = around(toward.direction, [&](const WideMap& map) {
      return count == 1 ? toward.texel : map.texelToward(toward.direction);
    });
    const LaneMask lit = which & (light.pdf > 0.0F);
    drawn.direction = select(lit, toward.direction, drawn.direction);
    drawn.radiance = select(lit, light.radiance, drawn.radiance);
    drawn.pdf = select(lit, light.pdf, drawn.pdf);
  }

  /// LightArrival in lanes.
  struct Arrival {
    Float3 radiance;
    Float pdf;
  };
  /// Radiance and density of all environments and skies together; texelOf(map): each map's texel in
  /// the direction.
  template <typename TexelOf>
  HWY_INLINE Arrival around(const Float3& direction, TexelOf&& texelOf) const {
    Arrival sum{around(direction), 0.0F};
    for (const MapTables& each : m_scene.maps) {
      const WideMap map(each);
      const Float3 radiance = map.radiance(texelOf(map));
      sum.radiance = sum.radiance + radiance;
      sum.pdf = sum.pdf + map.pdf(radiance);
    }
    return sum;
  }

  /// Radiance of constant environments and skies.
  HWY_INLINE Float3 around(const Float3& direction) const {
    Float3 sum = Float3(m_scene.constantEnvironment);
    for (const EventScene::Sky& sky : m_scene.skies) {
      const Float t = min(max(dot(Float3(sky.up), direction), -1.0F), 1.0F);
      const Float3 slope = select(t < 0.0F, Float3(sky.toBottom), Float3(sky.toTop));
      sum = sum + Float3(sky.middle) + abs(t) * slope;
    }
    return sum;
  }

  static HWY_INLINE Float3 weighted(LaneMask met, Float scatterPdf, Float pdf,
                                    const EventScene::Triple& radiance) {
    const Float weight = scatterPdf / (scatterPdf + pdf);
    return orZero(met, weight * Float3(radiance));
  }

  static HWY_INLINE Float3 arrivingFrom(const EventScene::Area& light, LaneMask which,
                                        const Float3& origin, const Float3& direction,
                                        Float distance, Float scatterPdf) {
    const Float3 normal = Float3(light.normal);
    const Float cosine = -dot(normal, direction);
    const Float t = dot(normal, origin - Float3(light.center)) / cosine;
    const LaneMask ahead = (cosine > 0.0F) & (t > 0.0F) & (t < distance);
    LaneMask met = which & ahead;
    if (!met.any())
      return {0.0F, 0.0F, 0.0F};
    const Float3 d = origin + t * direction - Float3(light.center);
    const Float x2 = square(dot(d, Float3(light.right)) * light.perRight);
    const Float y2 = square(dot(d, Float3(light.up)) * light.perUp);
    met = met & ((light.disk ? x2 + y2 : max(x2, y2)) <= 1.0F);
    const Float pdf = light.share * square(t) / (light.area * cosine);
    return weighted(met, scatterPdf, pdf, light.radiance);
  }

  static HWY_INLINE Float3 arrivingFrom(const EventScene::Sphere& light, LaneMask which,
                                        const Float3& origin, const Float3& direction,
                                        Float distance, Float scatterPdf) {
    const Float3 d = Float3(light.center) - origin;
    const Float distance2 = dot(d, d);
    const Float along = dot(d, direction);
    const Float3 across = d - along * direction;
    const Float across2 = dot(across, across);
    const Float radius2 = light.radius2;
    const LaneMask ahead = (along > 0.0F) & (across2 <= radius2);
    const LaneMask hits = (distance2 <= radius2) | ahead;
    const Float far = distanceTo(light, distance2, along, across2);
    const LaneMask met = which & hits & (far < distance);
    if (!met.any())
      return {0.0F, 0.0F, 0.0F};
    const Float pdf = densityOf(light, spreadOf(light, distance2));
    return weighted(met, scatterPdf, pdf, light.radiance);
  }

  const EventScene& m_scene;
};

} // namespace fenestra::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
