#include "phantoms/FootBones.h"

#include "phantoms/Anatomy.h"
#include "phantoms/Noise.h"

namespace fenestra::core {

namespace {

constexpr double jointBlend = 1.5; ///< mm; rounding at the edge of an articular surface

/// Metatarsal or phalanx between the centers of its two ends. `radii`: half widths (across, plantar
/// to dorsal) at base, mid-shaft and head. `bow`: dorsal offset of the mid-shaft, mm.
Solid longBone(const Vec3& base, const Vec3& head, const std::vector<Vec2>& radii, double bow) {
  const double length = (head - base).norm();
  const Vec2 top(0.0, bow);
  const Vec2 baseRadii = radii.at(0), shaftRadii = radii.at(1), headRadii = radii.at(2);
  const Vec2 neck = 0.45 * baseRadii + 0.55 * shaftRadii;
  const Solid bone = makeLoft({{0.0, Vec2::Zero(), 0.94 * baseRadii},
                               {0.10 * length, 0.2 * top, baseRadii},
                               {0.27 * length, 0.8 * top, neck},
                               {0.50 * length, top, shaftRadii},
                               {0.72 * length, 0.7 * top, 1.08 * shaftRadii},
                               {0.88 * length, 0.2 * top, headRadii},
                               {length, Vec2::Zero(), 0.88 * headRadii}},
                              0.25, 1.1 * headRadii.minCoeff());
  return placeSolid(toShape(base, head - base, Vec3::UnitZ()), bone);
}

FootBone makeBone(const Anatomy& entry, const std::vector<FootBone>& earlier) {
  FootBone bone{entry.at("id"), entry.at("name"), {}, {}};
  for (const std::string id : entry.at("neighbours"))
    for (std::size_t i = 0; i < earlier.size(); ++i)
      if (earlier[i].id == id)
        bone.neighbors.push_back(i);
  bone.gap = entry.value("gap", bone.gap);
  bone.base = entry.value("base", bone.base);
  bone.head = entry.value("head", bone.head);
  bone.cortex = entry.value("cortex", bone.cortex);
  bone.shaftCortex = entry.value("shaftCortex", bone.shaftCortex);
  bone.cancellousBone = entry.value("spongiosa", bone.cancellousBone);
  bone.shape = entry.contains("shape")
                   ? entry["shape"].get<Solid>()
                   : longBone(bone.base, bone.head, entry.at("radii"), entry.at("bow"));
  return bone;
}

} // namespace

FootBones::FootBones() {
  const Anatomy anatomy = loadAnatomy("foot");
  for (const Anatomy& entry : anatomy.at("bones"))
    m_bones.push_back(makeBone(entry, m_bones));
}

FootBones::Distances FootBones::distances(const Vec3& p) const {
  Distances distances;
  for (std::size_t i = 0; i < m_bones.size(); ++i) {
    const FootBone& bone = m_bones[i];
    distances[i] = maxDistance;
    if (!contains(expandBox(bone.shape.box, maxDistance), p))
      continue;
    double distance = bone.shape.distance(p);
    for (const std::size_t neighbor : bone.neighbors)
      distance = smoothDifference(distance, distances[neighbor] - bone.gap, jointBlend);
    const double roughness =
        0.25 * valueNoise(p / 6.0, 200 + i) + 0.1 * valueNoise(p / 2.3, 230 + i);
    distances[i] = std::min(distance + roughness, maxDistance);
  }
  return distances;
}

double FootBones::shaftPosition(std::size_t bone, const Vec3& p) const {
  const Vec3 axis = m_bones[bone].head - m_bones[bone].base;
  if (axis.isZero())
    return 0.0;
  const double t = (p - m_bones[bone].base).dot(axis) / axis.squaredNorm();
  return smoothStep(0.12, 0.38, t) * smoothStep(0.92, 0.68, t);
}

} // namespace fenestra::core
