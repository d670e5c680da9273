#pragma once
// Bones of a right knee in extension, and their cartilage, as distance functions.
//
// World is RAS, mm: x to the lateral side (R), y anterior, z superior; the origin is the middle of
// the joint line, under the intercondylar notch. Adult proportions.

#include "phantoms/Shapes.h"

#include <array>

namespace fenestra {

/// Round defect of the femoral cartilage, centred at `x` along the transverse axis and `angle`
/// around it.
struct CartilageLesion {
  double x;        ///< mm
  double angle;    ///< radians around the transcondylar axis, 0 anterior, -pi/2 distal
  double diameter; ///< mm
  double depth;    ///< share of the cartilage that is missing
};

/// Lesion on the medial slope of the lower trochlea, with the notch behind, not more cartilage: a
/// view from in front through the lesion meets the bone of its floor.
inline constexpr CartilageLesion fullThicknessLesion{-4.8, -0.48, 8.0, 1.0};
/// Lesion on the lateral condyle.
inline constexpr CartilageLesion partialThicknessLesion{22.5, -0.62, 9.0, 0.5};

class KneeBones {
public:
  KneeBones();

  /// Distances to the bones' outer surfaces, mm; `beyond` if a bone is farther than `beyond`.
  double femur(const Vec3& point) const;
  double tibia(const Vec3& point) const;
  double fibula(const Vec3& point) const;
  double patella(const Vec3& point) const;
  static constexpr double maxDistance = 8.0;

  /// Thickness of the cartilage, mm, on the bone's surface near `point`; 0 off the joint's faces;
  /// lesions included.
  double femoralCartilage(const Vec3& point) const;
  double intactFemoralCartilage(const Vec3& point) const; ///< without lesions
  double tibialCartilage(const Vec3& point) const;
  double patellarCartilage(const Vec3& point) const;

  /// Point on the femur's surface, on the trochlea or a condyle; x and angle as in CartilageLesion.
  Vec3 femoralSurface(double x, double angle) const;

private:
  double femurField(const Vec3& point) const;
  double wheelField(const Vec3& point) const;
  double tibiaField(const Vec3& point) const;
  double patellaField(const Vec3& point) const;
  /// Distance to the surface where a field is 0, roughened; the bone lies in `box`.
  double distance(const Box& box, double (KneeBones::*field)(const Vec3&) const, std::uint64_t seed,
                  const Vec3& point) const;
  double profile(double angle) const;

  static constexpr int profileSteps = 360;
  std::array<double, profileSteps + 1> m_profile; ///< sagittal radius of the femur by angle
  Solid m_femoralShaft, m_tibialShaft, m_fibula, m_patellaBody;
};

} // namespace fenestra
