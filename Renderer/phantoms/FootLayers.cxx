#include "phantoms/FootLayers.h"

#include "phantoms/Noise.h"

namespace fenestra {

namespace {

constexpr double footSkinThickness = 1.6;

const Rgb tendonColor{0.718, 0.839, 0.827};

double trabeculae(const Vec3& p) {
  return 90.0 * valueNoise(p / 1.6, 270) + 60.0 * valueNoise(p / 4.0, 271);
}

} // namespace

FootLayers::FootLayers() {
  m_superficial = extensorTendons();
  m_superficial.push_back(achillesTendon());
  addBones();
  addSoftTissue();
}

/// Distance to the skin, mm; the skin bulges over bones and raised tendons.
double FootLayers::surface(const Vec3& p, double nearestBone) const {
  constexpr double overBone = 4.2, overTendon = 2.6, blend = 5.0;
  double surface = smoothUnion(m_outline.distance(p), nearestBone - overBone, blend);
  for (const Tube& tendon : m_superficial)
    if (contains(expanded(tendon.box(), overTendon + 2.0 * blend), p))
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

std::uint8_t FootLayers::segment(const std::string& id, const std::string& name, const Rgb& color) {
  const auto label = static_cast<std::uint8_t>(m_segments.size() + 1);
  m_segments.push_back({id, name, color, label, 0});
  return label;
}

void FootLayers::layer(std::uint8_t label, FootTissue tissue, const Box& box, Distance distance) {
  m_layers.push_back({label, tissue, expanded(box, boxMargin), std::move(distance)});
}

void FootLayers::tubes(std::uint8_t label, FootTissue tissue, const std::vector<Tube>& tubes,
                       double depth) {
  for (const Tube& tube : tubes)
    layer(label, tissue, tube.box(), [tube, depth](const FootSite& s) {
      return std::max(tube.distance(s.point), s.surface + depth);
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
  const auto cartilage = segment("joints", "Joint cartilage and capsules", {0.435, 0.722, 0.824});
  layer(cartilage, FootTissue::cartilage, everywhere, [](const FootSite& s) {
    constexpr double halfWidth = 2.3; // mm; half of the gap that a capsule bridges
    return std::max(0.5 * (s.bones[s.nearest] + s.second) - halfWidth,
                    s.surface + footSkinThickness);
  });
  const auto achilles = segment("achilles_tendon", "Achilles tendon", tendonColor);
  tubes(achilles, FootTissue::tendon, {achillesTendon()}, footSkinThickness + 0.5);
  const auto tendons = segment("tendons", "Tendons", tendonColor);
  tubes(tendons, FootTissue::tendon, extensorTendons(), footSkinThickness + 0.5);
  tubes(tendons, FootTissue::tendon, flexorTendons(), footSkinThickness + 0.5);
  tubes(segment("plantar_aponeurosis", "Plantar aponeurosis", tendonColor), FootTissue::tendon,
        {plantarAponeurosis()}, footSkinThickness + 2.0);
  tubes(segment("vessels", "Vessels", {0.847, 0.396, 0.310}), FootTissue::vessel, footVessels(),
        footSkinThickness + 0.4);
  const auto muscles = segment("muscles", "Muscles", {0.753, 0.408, 0.345});
  for (const Tube& belly : footMuscles())
    layer(muscles, FootTissue::muscle, belly.box(), [belly](const FootSite& s) {
      const double shape = belly.distance(s.point) + 0.6 * valueNoise(s.point / 6.0, 277);
      return std::max(shape, s.fascia);
    });
  layer(segment("fat", "Fat", {0.902, 0.863, 0.275}), FootTissue::fat, everywhere,
        [](const FootSite& s) { return s.surface + footSkinThickness; });
  layer(segment("skin", "Skin", {0.694, 0.478, 0.396}), FootTissue::skin, everywhere,
        [](const FootSite& s) { return s.surface; });
}

} // namespace fenestra
