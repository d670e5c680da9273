#include "phantoms/FootLayers.h"

#include "phantoms/Anatomy.h"
#include "phantoms/Noise.h"

namespace fenestra {

namespace {

constexpr double footSkinThickness = 1.6; ///< mm
constexpr double footNoise = 14.0;        ///< HU, standard deviation

double trabeculae(const Vec3& p) {
  return 90.0 * valueNoise(p / 1.6, 270) + 60.0 * valueNoise(p / 4.0, 271);
}

/// Height of the sole over the floor, mm: the medial arch.
double soleHeight(const Vec3& p) {
  const double across = (p.x() + 40.0) / 24.0, along = (p.y() - 112.0) / 42.0;
  return 16.0 * std::exp(-across * across - along * along);
}

/// Thickness of skin and subcutaneous fat, mm; large under the sole.
double footFasciaDepth(const Vec3& p) {
  const double plantar = smoothStep(20.0, 6.0, p.z()) * smoothStep(205.0, 190.0, p.y());
  const double heel = smoothStep(45.0, 20.0, p.y()) * smoothStep(30.0, 12.0, p.z());
  const double leg = smoothStep(70.0, 110.0, p.z());
  return 2.8 + 3.2 * plantar + 4.5 * heel + 1.6 * leg + 0.4 * valueNoise(p / 14.0, 262);
}

} // namespace

FootOutline::FootOutline() {
  const Anatomy anatomy = anatomyOf("foot");
  anatomy.at("leg").get_to(m_leg);
  anatomy.at("toes").get_to(m_toes);
  const Solid shape = anatomy.at("body");
  const auto sole = [](const Vec3& p) { return soleHeight(p) - p.z(); };
  // The web of the toes runs backward from the great toe to the little one.
  const auto web = [](const Vec3& p) {
    return (p.y() - 208.0 + 0.40 * (p.x() + 15.0)) / std::hypot(1.0, 0.40);
  };
  m_body = {[shape, sole, web](const Vec3& p) {
              const double body = smoothIntersection(shape.distance(p), sole(p), 12.0);
              return smoothIntersection(body, web(p), 9.0);
            },
            shape.box};
}

double FootOutline::distance(const Vec3& p) const {
  double surface = smoothUnion(m_leg.distance(p), m_body.distance(p), 16.0);
  for (const Solid& toe : m_toes) {
    constexpr double blend = 5.0;
    if (contains(expanded(toe.box, blend + 1.0), p))
      surface = smoothUnion(surface, toe.distance(p), blend);
  }
  return surface + 0.3 * valueNoise(p / 12.0, 261);
}

FootLayers::FootLayers() : LayeredSubject(1.5) {
  addBones();
  addSoftTissue();
}

/// Distance to the skin, mm; the skin bulges over bones and raised tendons.
double FootLayers::surface(const Vec3& p, double nearestBone) const {
  constexpr double overBone = 4.2, overTendon = 2.6, blend = 5.0;
  double surface = smoothUnion(m_outline.distance(p), nearestBone - overBone, blend);
  for (const Solid& tendon : m_superficial)
    if (contains(expanded(tendon.box, overTendon + 2.0 * blend), p))
      surface = smoothUnion(surface, tendon.distance(p) - overTendon, blend);
  return surface;
}

FootSite FootLayers::site(const Vec3& p) const {
  FootSite s{};
  s.point = p;
  s.bones = m_bones.distances(p);
  const auto nearest = std::min_element(s.bones.begin(), s.bones.end());
  s.nearest = static_cast<std::size_t>(nearest - s.bones.begin());
  s.second = FootBones::beyond;
  for (std::size_t i = 0; i < s.bones.size(); ++i)
    if (i != s.nearest)
      s.second = std::min(s.second, s.bones[i]);
  s.shaft = m_bones.shaft(s.nearest, p);
  s.surface = surface(p, *nearest);
  s.fascia = s.surface + footFasciaDepth(p);
  return s;
}

double FootLayers::signal(FootTissue tissue, const FootSite& s) const {
  const Vec3& p = s.point;
  switch (tissue) {
  case FootTissue::cortex:
    return std::lerp(820.0, 1450.0, s.shaft) + 90.0 * valueNoise(p / 3.0, 272);
  case FootTissue::marrow:
    return std::lerp(m_bones.bones()[s.nearest].spongiosa + trabeculae(p), -40.0, s.shaft);
  case FootTissue::cartilage:
    return 85.0;
  case FootTissue::tendon:
    return 105.0 + 10.0 * valueNoise(p / 2.0, 273);
  case FootTissue::vessel:
    return 45.0;
  case FootTissue::muscle:
    return 55.0 + 12.0 * valueNoise(p.cwiseQuotient(Vec3{3.0, 9.0, 3.0}), 274);
  case FootTissue::fat:
    return -105.0 + 12.0 * valueNoise(p / 5.0, 275);
  case FootTissue::skin:
    return 35.0;
  }
  return 0.0;
}

std::int16_t FootLayers::acquired(double signal, const Vec3&, std::uint64_t voxel) const {
  const double noisy = std::clamp(signal + footNoise * normalNoise(voxel), -1024.0, 3071.0);
  return static_cast<std::int16_t>(std::lround(noisy));
}

void FootLayers::shapes(std::uint8_t label, FootTissue tissue, const std::vector<Solid>& shapes,
                        double depth) {
  for (const Solid& shape : shapes)
    layer(label, tissue, shape.box, [shape, depth](const FootSite& s) {
      return std::max(shape.distance(s.point), s.surface + depth);
    });
}

void FootLayers::addBones() {
  for (std::size_t i = 0; i < FootBones::count; ++i) {
    const FootBone& bone = m_bones.bones()[i];
    const auto label = segment(bone.id, bone.name, boneColor);
    const double ends = bone.cortex, middle = bone.shaftCortex;
    layer(label, FootTissue::marrow, bone.shape.box, [=](const FootSite& s) {
      const double thickness = i == s.nearest ? std::lerp(ends, middle, s.shaft) : ends;
      return s.bones[i] + thickness + 0.15 * valueNoise(s.point / 4.0, 276);
    });
    layer(label, FootTissue::cortex, bone.shape.box, [i](const FootSite& s) { return s.bones[i]; });
  }
}

void FootLayers::addSoftTissue() {
  const auto cartilage = segment("joints", "Joint cartilage and capsules", cartilageColor);
  layer(cartilage, FootTissue::cartilage, everywhere, [](const FootSite& s) {
    constexpr double halfWidth = 2.3; // mm; half of the gap that a capsule bridges
    return std::max(0.5 * (s.bones[s.nearest] + s.second) - halfWidth,
                    s.surface + footSkinThickness);
  });
  const Anatomy anatomy = anatomyOf("foot");
  const std::vector<Solid> achilles = anatomy.at("achilles tendon");
  anatomy.at("extensor tendons").get_to(m_superficial);
  m_superficial.insert(m_superficial.end(), achilles.begin(), achilles.end());
  shapes(segment("achilles_tendon", "Achilles tendon", tendonColor), FootTissue::tendon, achilles,
         footSkinThickness + 0.5);
  const auto tendons = segment("tendons", "Tendons", tendonColor);
  for (const char* kind : {"extensor tendons", "flexor tendons"})
    shapes(tendons, FootTissue::tendon, anatomy.at(kind), footSkinThickness + 0.5);
  shapes(segment("plantar_aponeurosis", "Plantar aponeurosis", tendonColor), FootTissue::tendon,
         anatomy.at("plantar aponeurosis"), footSkinThickness + 2.0);
  shapes(segment("vessels", "Vessels", vesselColor), FootTissue::vessel, anatomy.at("vessels"),
         footSkinThickness + 0.4);
  const auto muscles = segment("muscles", "Muscles", muscleColor);
  for (const Solid belly : anatomy.at("muscles"))
    layer(muscles, FootTissue::muscle, belly.box, [belly](const FootSite& s) {
      const double shape = belly.distance(s.point) + 0.6 * valueNoise(s.point / 6.0, 277);
      return std::max(shape, s.fascia);
    });
  layer(segment("fat", "Fat", fatColor), FootTissue::fat, everywhere,
        [](const FootSite& s) { return s.surface + footSkinThickness; });
  layer(segment("skin", "Skin", skinColor), FootTissue::skin, everywhere,
        [](const FootSite& s) { return s.surface; });
}

} // namespace fenestra
