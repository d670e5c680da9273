#pragma once
// Scalar counterpart of base/Simd-inl.h and base/SimdMath-inl.h: one lane, in double. Formulas that
// scalar and SIMD code share are written once, with these names, in files named *Formulas-inl.h.
// Each is included inside a namespace: fenestra::core::scalar, or that of an instruction set.

#include "base/Vector.h"

#include <array>

/// Highway's HWY_INLINE, for shared formulas.
#define FENESTRA_INLINE inline __attribute__((always_inline))

namespace fenestra::core::scalar {

using Real = double; ///< the type of one lane of Float
using Float = double;

/// LaneMask of one lane.
struct ScalarMask {
  bool value;

  ScalarMask(bool value) : value(value) {}
  static ScalarMask none() { return false; }
  bool any() const { return value; }
  ScalarMask without(ScalarMask other) const { return value && !other.value; }
  ScalarMask operator&(ScalarMask other) const { return value && other.value; }
  ScalarMask operator|(ScalarMask other) const { return value || other.value; }
};
using LaneMask = ScalarMask;

inline Float select(LaneMask m, Float yes, Float no) {
  return m.value ? yes : no;
}
inline Float zeroUnless(LaneMask m, Float yes) {
  return m.value ? yes : 0.0;
}
/// Returns b if a or b is NaN.
inline Float min(Float a, Float b) {
  return a < b ? a : b;
}
/// Returns b if a or b is NaN.
inline Float max(Float a, Float b) {
  return a > b ? a : b;
}
/// a b + c.
inline Float fma(Float a, Float b, Float c) {
  return a * b + c;
}
/// a b - c.
inline Float fms(Float a, Float b, Float c) {
  return a * b - c;
}
/// c - a b.
inline Float fnma(Float a, Float b, Float c) {
  return c - a * b;
}
inline Float abs(Float x) {
  return std::abs(x);
}
inline Float sqrt(Float x) {
  return std::sqrt(x);
}
inline Float copySign(Float magnitude, Float sign) {
  return std::copysign(magnitude, sign);
}
/// True with the given probability, for a uniform number in [0, 1).
inline LaneMask sampleBernoulli(Real probability, Float uniform) {
  return uniform < probability;
}
inline bool isAllEqual(Float x, Real value) {
  return x == value;
}

#include "base/VectorFormulas-inl.h"

/// Cosine and sine of an angle in turns.
inline CosineSine cosSinTurns(Float turns) {
  const double angle = 2.0 * pi * turns;
  return {std::cos(angle), std::sin(angle)};
}

inline Vec3 toVector(const Float3& v) {
  return {v.x, v.y, v.z};
}
inline Rgb toColor(const Float3& v) {
  return {v.x, v.y, v.z};
}

} // namespace fenestra::core::scalar
