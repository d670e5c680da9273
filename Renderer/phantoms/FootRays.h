#pragma once
// Five rays of a right foot: metatarsals and phalanges, in the frame of FootBones.h.

#include "phantoms/Shapes.h"

#include <string>
#include <vector>

namespace fenestra {

/// Long bone between the middles of its two ends; half widths in mm.
struct LongBone {
  std::string id, name;
  Vec3 base, head;
  Vec2 baseRadii, shaftRadii, headRadii; ///< across, and plantar to dorsal
  double bow;                            ///< mm; dorsal bow of the shaft's middle
  double cortex, shaftCortex;            ///< mm; at the ends and mid-shaft
  double spongiosa;                      ///< HU at the ends
  std::vector<std::string> neighbours;   ///< ids of bones whose joints cut this one

  Solid shape() const;
};

/// Bones of ray 1 to 5, each ray from its metatarsal to its last phalanx: 19 bones.
std::vector<LongBone> footRays();

} // namespace fenestra
