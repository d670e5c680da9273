#pragma once
// Soft tissue of a right foot, as shapes in the frame of FootBones.h.

#include "phantoms/Shapes.h"

#include <vector>

namespace fenestra {

/// Surface of the skin without the bulges of bones and tendons; mm.
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

/// Muscle bellies in the leg, and the short muscles of sole and dorsum.
std::vector<Tube> footMuscles();

/// Thickness of skin and subcutaneous fat, mm; large under the sole.
double footFasciaDepth(const Vec3& point);

} // namespace fenestra
