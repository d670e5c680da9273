// Lights for many paths: model/lights/LightSet.h in lanes. A part of the namespace that includes
// it, behind Scene-inl.h.

#include "model/lights/LightFormulas-inl.h"
#include "transport/lanes/EnvironmentSampler-inl.h"

/// LightSet in lanes.
class WideLights {
public:
  explicit HWY_INLINE WideLights(const EventScene& scene) : m_scene(scene) {}

  bool some() const {
    const LightTables<float>& lights = m_scene.lights;
    return !lights.areas.empty() || !lights.directionals.empty() || !lights.spheres.empty() ||
           !m_scene.maps.empty();
  }

  /// Draws one light for each lane of `which`, seen from a local point. `choice` selects the
  /// light; `uBits`, `vBits`: random bits.
  LightDraw draw(LaneMask which, const Float3& point, Float choice, Word uBits, Word vBits) const {
    const Float u = uniformOf(uBits), v = uniformOf(vBits);
    LightDraw drawn = drawLight(m_scene.lights, which, point, choice, u, v);
    if (!m_scene.maps.empty() && which.any())
      drawMaps(which, choice, uBits, vBits, drawn);
    return drawn;
  }

  /// Light that scattered rays from local points meet before `distance`, or at infinity, weighted
  /// against drawing that light (Veach 1997, eq. 9.8).
  Float3 arriving(LaneMask which, const Float3& origin, const Float3& direction, Float distance,
                  Float scatterPdf) const {
    Float3 sum{0.0F, 0.0F, 0.0F};
    forEachMet(m_scene.lights, which, origin, direction, distance,
               [&](LaneMask met, const Float3& radiance, Float pdf) {
                 const Float weight = scatterPdf / (scatterPdf + pdf);
                 sum = sum + orZero(met, weight * radiance);
               });
    const LaneMask escaped = which & (distance == std::numeric_limits<float>::infinity());
    if (m_scene.maps.empty())
      return sum + orZero(escaped, around(m_scene.lights, direction));
    if (!escaped.any())
      return sum;
    const Arrival far =
        withMaps(direction, [&](const MapTables& map) { return texelToward(map, direction); });
    const Float weight = scatterPdf / (scatterPdf + far.pdf);
    return sum + orZero(escaped, weight * far.radiance);
  }

private:
  void drawMaps(LaneMask which, Float choice, Word u, Word v, LightDraw& drawn) const {
    const std::size_t count = m_scene.maps.size();
    TexelDraw toward = drawTexel(m_scene.maps[0], u, v);
    LaneMask later = which;
    for (std::size_t i = 1; i < count; ++i) { // the last map takes the remainder of rounding
      const float before = m_scene.maps[i - 1].share;
      later = later & (choice > before);
      choice = choice - before;
      if (later.any())
        toward.direction =
            select(later, drawTexel(m_scene.maps[i], u, v).direction, toward.direction);
    }
    const Arrival light = withMaps(toward.direction, [&](const MapTables& map) {
      return count == 1 ? toward.texel : texelToward(map, toward.direction);
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
  HWY_INLINE Arrival withMaps(const Float3& direction, TexelOf&& texelOf) const {
    Arrival sum{around(m_scene.lights, direction), 0.0F};
    for (const MapTables& map : m_scene.maps) {
      const Float3 radiance = radianceOf(map, texelOf(map));
      sum.radiance = sum.radiance + radiance;
      sum.pdf = sum.pdf + map.perBrightness * greatest(radiance);
    }
    return sum;
  }

  const EventScene& m_scene;
};
