#pragma once
// Scalar counterpart of base/Simd-inl.h and base/SimdMath-inl.h: one lane, in double. Here and
// there the formulas of formulas/README.md are included, inside a namespace:
// fenestra::core::scalar, or that of an instruction set.

#include "base/Formulas.h"
#include "base/Vector.h"

#include <array>
#include <cstdint>

namespace fenestra::core::scalar {

using Real = double; ///< the type of one lane of Float
#include "base/OneLane-inl.h"

/// Cosine and sine of an angle in turns.
inline CosineSine cosSinTurns(Float turns) {
  const double angle = 2.0 * pi * turns;
  return {std::cos(angle), std::sin(angle)};
}

/// Angle of the point (x, y) in turns from the x axis, in [-1/2, 1/2].
inline Float angleInTurns(Float x, Float y) {
  return std::atan2(y, x) / (2.0 * pi);
}

inline Vec3 toVector(const Float3& v) {
  return {v.x, v.y, v.z};
}
inline Rgb toColor(const Float3& v) {
  return {v.x, v.y, v.z};
}

} // namespace fenestra::core::scalar
