#pragma once
// The bones of a right knee in extension, and the cartilage on them, as distance functions.
//
// World is RAS, mm: x to the lateral side (R), y anterior, z superior; the origin is the middle of
// the joint line, under the intercondylar notch. The proportions are an adult's.

#include "phantoms/Shapes.h"

#include <array>

namespace fenestra {

/// A round defect of the femoral cartilage: on the transverse axis at `x`, `angle` below anterior.
struct CartilageLesion {
  double x;        ///< mm
  double angle;    ///< radians around the transcondylar axis, 0 anterior, -pi/2 distal
  double diameter; ///< mm
  double depth;    ///< share of the cartilage that is gone
};

/// On the medial slope of the lower trochlea: the notch is behind it, not more cartilage,
/// so that a view from in front through the lesion meets the bone of its floor.
inline constexpr CartilageLesion fullThicknessLesion{-4.8, -0.48, 8.0, 1.0};
/// On the lateral condyle.
inline constexpr CartilageLesion partialThicknessLesion{22.5, -0.62, 9.0, 0.5};

class KneeBones {
public:
  KneeBones();

  /// Distances in mm to the bones' outer surfaces; `beyond` where a bone is farther off than that.
  double femur(const Vec3& point) const;
  double tibia(const Vec3& point) const;
  double fibula(const Vec3& point) const;
  double patella(const Vec3& point) const;
  static constexpr double beyond = 8.0;

  /// Cartilage in mm over the bone's surface near `point`, 0 off the joint's faces; lesions
  /// included.
  double femoralCartilage(const Vec3& point) const;
  double intactFemoralCartilage(const Vec3& point) const; ///< as it would be without lesions
  double tibialCartilage(const Vec3& point) const;
  double patellarCartilage(const Vec3& point) const;

  /// Where the femur's surface lies under a place of the trochlea or a condyle, x and angle as in
  /// CartilageLesion.
  Vec3 femoralSurface(double x, double angle) const;

private:
  double femurField(const Vec3& point) const;
  double wheelField(const Vec3& point) const;
  double tibiaField(const Vec3& point) const;
  double patellaField(const Vec3& point) const;
  double profile(double angle) const;

  static constexpr int profileSteps = 360;
  std::array<double, profileSteps + 1> m_profile; ///< the femur's sagittal radius by angle
  Loft m_femoralShaft, m_tibialShaft, m_fibulaShaft, m_patellaBody;
  Box m_femurBox, m_tibiaBox, m_patellaBox, m_fibulaBox;
};

} // namespace fenestra
