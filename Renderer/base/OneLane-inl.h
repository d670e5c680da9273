// Types and functions of formulas/README.md for one lane. Included inside a namespace that defines
// Real, after base/Formulas.h and base/Vector.h.

using Float = Real;
using Int = std::int32_t;
using UInt = std::uint32_t;
using LaneMask = bool;
using AffineRow = std::array<Real, 4>;
using AffineRows = std::array<AffineRow, 3>;

CONSTANT Real infiniteReal = std::numeric_limits<Real>::infinity();
CONSTANT Real tinyReal = std::numeric_limits<Real>::min();

inline LaneMask noLanes() {
  return false;
}
inline LaneMask allLanes() {
  return true;
}
inline bool isAny(LaneMask m) {
  return m;
}
inline LaneMask both(LaneMask a, LaneMask b) {
  return a && b;
}
inline LaneMask either(LaneMask a, LaneMask b) {
  return a || b;
}
inline LaneMask without(LaneMask a, LaneMask b) {
  return a && !b;
}
inline Float select(LaneMask m, Float yes, Float no) {
  return m ? yes : no;
}
inline Float zeroUnless(LaneMask m, Float yes) {
  return m ? yes : Real(0);
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
/// For |x| < 2^63. Without SSE 4.1 std::floor is a function call.
inline Float floor(Float x) {
  const auto towardZero = static_cast<Float>(static_cast<std::int64_t>(x));
  return towardZero > x ? towardZero - 1 : towardZero;
}
inline Float expm1(Float x) {
  return std::expm1(x);
}
inline Float copySign(Float magnitude, Float sign) {
  return std::copysign(magnitude, sign);
}
inline Int select(LaneMask m, Int yes, Int no) {
  return m ? yes : no;
}
/// Rounds toward 0.
inline Int toInt(Float x) {
  return static_cast<Int>(x);
}
template <int by>
UInt shiftLeft(UInt x) {
  return x << by;
}
template <int by>
UInt shiftRight(UInt x) {
  return x >> by;
}
/// True with the given probability, for a uniform number in [0, 1).
inline LaneMask sampleBernoulli(Real probability, Float uniform) {
  return uniform < probability;
}
inline bool isAllEqual(Float x, Real value) {
  return x == value;
}

#include "base/Float3-inl.h"
#include "formulas/Random.inl"
#include "formulas/Vectors.inl"
