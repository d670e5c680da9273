#pragma once
// Bones of a right foot at rest with the ankle at a right angle, as distance functions.
//
// World is RAS, mm: x lateral (R), y anterior, z superior; the origin is on the floor under the
// back of the heel. Adult proportions: 26 bones, and the ends of the two leg bones.

#include "phantoms/Shapes.h"

#include <array>
#include <string>

namespace fenestra::core {

struct FootBone {
  std::string id;                     ///< "calcaneus", "metatarsal_1", "proximal_phalanx_1", ...
  std::string name;                   ///< display name
  Solid shape;                        ///< before its neighbors' joints are cut out
  std::vector<std::size_t> neighbors; ///< earlier bones, kept `gap` mm apart
  double gap = 2.0;                   ///< mm; joint width
  Vec3 base = Vec3::Zero(), head = Vec3::Zero(); ///< ends of a long bone; equal in others
  double cortex = 1.0, shaftCortex = 1.0;        ///< mm; thickness at the ends and mid-shaft
  double cancellousBone = 300.0;                 ///< HU between the trabeculae, at the ends
};

class FootBones {
public:
  static constexpr std::size_t count = 28;
  /// mm; larger distances are not computed.
  static constexpr double maxDistance = 12.0;
  using Distances = std::array<double, count>;

  FootBones();

  /// Bones, each listed after its neighbors.
  const std::vector<FootBone>& bones() const { return m_bones; }

  /// Distances to the bones' outer surfaces, mm, in the order of bones(); maxDistance if the
  /// bounding box is farther away.
  Distances distances(const Vec3& point) const;

  /// Position of `point` along a long bone's shaft: 0 at the ends, 1 in the middle.
  double shaftPosition(std::size_t bone, const Vec3& point) const;

private:
  std::vector<FootBone> m_bones;
};

} // namespace fenestra::core
