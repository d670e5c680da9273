#pragma once
// The five rays of a right foot: metatarsals and phalanges, in the frame of FootBones.h.

#include "phantoms/Shapes.h"

#include <string>
#include <vector>

namespace fenestra {

/// A long bone between the middles of its two ends; half widths in mm.
struct LongBone {
  std::string id, name;
  Vec3 base, head;
  Vec2 baseRadii, shaftRadii, headRadii; ///< across, and plantar to dorsal
  double bow;                            ///< mm that the shaft's middle stands out dorsally
  double cortex, shaftCortex;            ///< mm, at the ends and mid-shaft
  double spongiosa;                      ///< HU at the ends
  std::vector<std::string> neighbours;   ///< ids of the bones whose joints it is cut by

  Solid shape() const;
};

/// Ray by ray from the great toe, each from its metatarsal to its last phalanx: 19 bones.
std::vector<LongBone> footRays();

} // namespace fenestra
