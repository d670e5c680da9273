#pragma once
// What surrounds the bones of a right foot, as shapes in the frame of FootBones.h.

#include "phantoms/Shapes.h"

#include <vector>

namespace fenestra {

/// The skin's surface without what bones and tendons push out; mm.
class FootOutline {
public:
  FootOutline();
  double distance(const Vec3& point) const;

private:
  Solid m_leg, m_body;
  std::vector<Tube> m_toes;
};

std::vector<Tube> extensorTendons(); ///< on the dorsum
std::vector<Tube> flexorTendons();   ///< behind the malleoli and under the sole
Tube achillesTendon();
Tube plantarAponeurosis();
std::vector<Tube> footVessels();

/// Bellies in the leg, and the short muscles of sole and dorsum.
std::vector<Tube> footMuscles();

/// Thickness of skin and subcutaneous fat, mm: thick under the sole.
double footFasciaDepth(const Vec3& point);

} // namespace fenestra
