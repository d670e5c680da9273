#pragma once
// Bones of a right knee in extension, and their cartilage, as distance functions.
//
// World is RAS, mm: x lateral (R), y anterior, z superior; the origin is the middle of the joint
// line, under the intercondylar notch. Adult proportions.

#include "phantoms/Shapes.h"

#include <array>

namespace fenestra::core {

/// Round defect of the femoral cartilage, centered at `x` along the transcondylar axis and `angle`
/// around it.
struct CartilageLesion {
  double x;        ///< mm
  double angle;    ///< radians around the axis, 0 anterior, -pi/2 distal
  double diameter; ///< mm
  double depth;    ///< missing fraction of the cartilage
};

/// Lesion on the medial slope of the lower trochlea. Behind it is the notch and no more cartilage:
/// an anterior view through the lesion shows the bone at its floor.
inline constexpr CartilageLesion fullThicknessLesion{-4.8, -0.48, 8.0, 1.0};
/// Lesion on the lateral condyle.
inline constexpr CartilageLesion partialThicknessLesion{22.5, -0.62, 9.0, 0.5};

class KneeBones {
public:
  KneeBones();

  /// Distances to the bones' outer surfaces, mm; maxDistance if a bone's box is farther away. More
  /// than `reach` + 6 mm from a surface, they omit its noise, less than 0.5 mm.
  double femur(const Vec3& point, double reach = infinity) const;
  double tibia(const Vec3& point, double reach = infinity) const;
  double fibula(const Vec3& point, double reach = infinity) const;
  double patella(const Vec3& point, double reach = infinity) const;
  static constexpr double maxDistance = 8.0;

  /// Thickness of the cartilage, mm, on the bone's surface near `point`, including lesions; 0
  /// outside the articular surfaces.
  double femoralCartilage(const Vec3& point) const;
  double intactFemoralCartilage(const Vec3& point) const; ///< without lesions
  /// femoralCartilage, from the thickness without lesions.
  double applyLesions(double intact, const Vec3& point) const;
  double tibialCartilage(const Vec3& point) const;
  double patellarCartilage(const Vec3& point) const;

  /// Point on the femur's surface at the trochlea or a condyle; x and angle as in CartilageLesion.
  Vec3 femoralSurface(double x, double angle) const;

private:
  double femurField(const Vec3& point) const;
  double condyleField(const Vec3& point) const;
  double tibiaField(const Vec3& point) const;
  double patellaField(const Vec3& point) const;
  /// Distance to the zero level of a field, with surface noise; the bone lies in `box`.
  double distance(const Box& box, double (KneeBones::*field)(const Vec3&) const, std::uint64_t seed,
                  const Vec3& point, double reach) const;
  double profile(double angle) const;

  static constexpr int profileSteps = 360;
  std::array<double, profileSteps + 1> m_profile; ///< sagittal radius of the femur by angle
  Solid m_femoralShaft, m_tibialShaft, m_fibula, m_patellaBody;
};

} // namespace fenestra::core
