#pragma once
// Soft tissue of the knee, as shapes in the frame of KneeBones.h.

#include "phantoms/Shapes.h"

namespace fenestra {

/// Outer surface of the leg; the kneecap protrudes in front. `trunk`: without kneecap and tubercle.
double legOutline(const Solid& trunk, const Vec3& point);

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
inline constexpr MeniscusRing medialMeniscus{{-20.0, -4.5}, {18.0, 23.5}, 0.56, 0.62, 0.0};
inline constexpr MeniscusRing lateralMeniscus{{20.0, -5.5}, {17.0, 19.0}, 0.50, 0.42, pi};

/// Thin sheets from the kneecap's sides to the condyles.
double patellarRetinaculum(const Vec3& point);
double infrapatellarFatPad(const Vec3& point);
/// Joint cavity above the kneecap, between the quadriceps tendon and the femur.
double suprapatellarRecess(const Vec3& point);

} // namespace fenestra
