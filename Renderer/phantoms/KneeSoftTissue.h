#pragma once
// Soft tissue of the knee, as shapes in the frame of KneeBones.h.

#include "phantoms/Shapes.h"

namespace fenestra {

/// Outer surface of the leg; the kneecap protrudes in front.
class LegOutline {
public:
  LegOutline();
  double distance(const Vec3& point) const;

private:
  Solid m_trunk; ///< without kneecap and tubercle
};

/// Depth of the fascia under the skin's surface, mm: thickness of skin and subcutaneous fat.
double fasciaDepth(const Vec3& point);

/// Meniscus before the joint's faces cut it: a wedge-shaped ring around one plateau, open toward
/// the eminence.
struct MeniscusRing {
  Vec2 center;
  Vec2 outerRadii;     ///< mm
  double innerShare;   ///< inner / outer radius, in the middle of the C
  double openingAngle; ///< half of the C's gap, radians, around `opening`
  double opening;      ///< direction to the eminence: 0 lateral, pi medial

  double distance(const Vec3& point) const;
};
MeniscusRing medialMeniscus();
MeniscusRing lateralMeniscus();

/// Thin sheets from the kneecap's sides to the condyles.
double patellarRetinaculum(const Vec3& point);
double infrapatellarFatPad(const Vec3& point);
/// Joint cavity above the kneecap, between the quadriceps tendon and the femur.
double suprapatellarRecess(const Vec3& point);

} // namespace fenestra
