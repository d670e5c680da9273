#pragma once
// The bones of a right foot at rest with the ankle at a right angle, as distance functions.
//
// World is RAS, mm: x to the lateral side (R), y anterior, z superior; the origin is on the floor
// under the back of the heel. The proportions are an adult's: 26 bones, and the ends of the two of
// the leg.

#include "phantoms/Shapes.h"

#include <array>
#include <string>

namespace fenestra {

struct FootBone {
  std::string id;                      ///< "calcaneus", "metatarsal_1", "proximal_phalanx_1", ...
  std::string name;                    ///< for people
  Solid shape;                         ///< before its neighbours' joints are cut out of it
  std::vector<std::size_t> neighbours; ///< earlier bones that it keeps a joint's width from
  double gap = 2.0;                    ///< that width, mm
  Vec3 base = Vec3::Zero(), head = Vec3::Zero(); ///< of a long bone; equal in others
  double cortex = 1.0, shaftCortex = 1.0;        ///< thickness at the ends and mid-shaft, mm
  double spongiosa = 300.0;                      ///< HU between the trabeculae's ends
};

class FootBones {
public:
  static constexpr std::size_t count = 28;
  /// In mm: no bone is asked from farther off.
  static constexpr double beyond = 12.0;
  using Distances = std::array<double, count>;

  FootBones();

  /// Each comes after its neighbours.
  const std::vector<FootBone>& bones() const { return m_bones; }

  /// Distances in mm to the bones' outer surfaces, in their order; `beyond` where a bone's box is
  /// farther off than that.
  Distances distances(const Vec3& point) const;

  /// How much of a long bone's shaft a place is level with: 0 at the ends, 1 in the middle.
  double shaft(std::size_t bone, const Vec3& point) const;

private:
  void add(FootBone bone, const std::vector<std::string>& neighbours);
  void addHindfoot();
  void addLegStumps();
  void addMidfoot();
  void addRays();

  std::vector<FootBone> m_bones;
};

} // namespace fenestra
