#pragma once
// Words of lane code (base/Simd-inl.h, base/SimdMath-inl.h) for plain numbers: one lane, in
// double. Formulas that plain code and lanes share are written once, with these words, in files
// named *Formulas-inl.h: each is a part of the namespace that includes it, fenestra::plain or an
// instruction set's.

#include "base/Vector.h"

#include <array>

/// Highway's HWY_INLINE, for formulas.
#define FENESTRA_INLINE inline __attribute__((always_inline))

namespace fenestra::scalar {

using Real = double; ///< the plain number of which Float is one a lane
using Float = double;

/// True or false.
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
/// b where either is NaN.
inline Float min(Float a, Float b) {
  return a < b ? a : b;
}
/// b where either is NaN.
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
/// An event of that probability, by a uniform number of [0, 1).
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

} // namespace fenestra::scalar
