#pragma once
// Analytic subject of the format variants: a body with four different organs, none on an axis, so
// that every flip, permutation or shift of axes changes the image.

#include "base/Vector.h"

#include <algorithm>

namespace fenestra::core::testing {

/// Partial coverage by a shape: 1 for distances <= -1/2 mm, 0 for distances >= 1/2 mm.
inline double coverage(double signedDistance) {
  return std::clamp(0.5 - signedDistance, 0.0, 1.0);
}

inline double sphere(const Vec3& p, const Vec3& center, double radius) {
  return (p - center).norm() - radius;
}

/// Signed distances of the organs in mm; `p` is in RAS, mm.
inline double liver(const Vec3& p) {
  return sphere(p, {7.0, 7.0, 5.0}, 5.5);
}
inline double heart(const Vec3& p) {
  return sphere(p, {-7.0, 8.0, -4.0}, 4.5);
}
inline double tumor(const Vec3& p) {
  return sphere(p, {-5.0, 9.0, 8.0}, 3.0);
}
/// Rod with a flat end at S 3.
inline double spine(const Vec3& p) {
  const double across = std::hypot(p.x() - 4.0, p.y() + 6.0) - 3.0;
  return std::max(across, p.z() - 3.0);
}

/// Scalar of the subject, from 0 (air) to 250; about 60 in the body.
inline double subject(const Vec3& p) {
  const double body = (p.cwiseQuotient(Vec3(17.0, 15.0, 16.0)).norm() - 1.0) * 15.0;
  double value = 60.0 * coverage(body);
  const auto add = [&](double signedDistance, double organ) {
    value += coverage(signedDistance) * (organ - value);
  };
  add(liver(p), 140.0);
  add(heart(p), 190.0);
  add(spine(p), 250.0);
  add(tumor(p), 220.0);
  return value;
}

} // namespace fenestra::core::testing
