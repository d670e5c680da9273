// Vectors of floats, one number a lane, and tools shared by all lane code: arithmetic in three
// dimensions, random numbers, angles. Compiled once for each instruction set: include after
// Highway's foreach_target.h.

#if defined(FENESTRA_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef FENESTRA_LANES_INL_H
#undef FENESTRA_LANES_INL_H
#else
#define FENESTRA_LANES_INL_H
#endif

#include "base/Narrow.h"

#include <bit>
#include <cstdint>
#include <initializer_list>

#include <hwy/cache_control.h>
#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace fenestra::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::ScalableTag<float>;
using Ints = hn::RebindToSigned<Floats>;
using Bits = hn::RebindToUnsigned<Floats>;
using F = hn::Vec<Floats>;
using I = hn::Vec<Ints>;
using U = hn::Vec<Bits>;
using M = hn::Mask<Floats>;

inline constexpr Floats floats{};
inline constexpr Ints ints{};
inline constexpr Bits bits{};

HWY_INLINE F all(float x) {
  return hn::Set(floats, x);
}
HWY_INLINE M both(M a, M b) {
  return hn::And(a, b);
}
HWY_INLINE M noLane() {
  return hn::FirstN(floats, 0);
}
/// Mask as one bit a lane; maskOf() is the inverse.
HWY_INLINE std::uint64_t bitsOf(M m) {
  std::uint64_t packed = 0;
  hn::StoreMaskBits(floats, m, reinterpret_cast<std::uint8_t*>(&packed));
  return packed;
}
HWY_INLINE M maskOf(std::uint64_t packed) {
  return hn::LoadMaskBits(floats, reinterpret_cast<const std::uint8_t*>(&packed));
}
/// Calls visit(lane) for every lane of `which`.
template <typename Visit>
HWY_INLINE void forEachLane(M which, Visit&& visit) {
  for (std::uint64_t left = bitsOf(which); left != 0; left &= left - 1)
    visit(static_cast<std::size_t>(std::countr_zero(left)));
}

HWY_INLINE F lerp(F a, F b, F f) {
  return hn::MulAdd(hn::Sub(b, a), f, a);
}
HWY_INLINE F notBelow0(F x) {
  return hn::Max(x, hn::Zero(floats));
}
/// sqrt(max(x, 0)): rounding may have made x negative.
HWY_INLINE F root(F x) {
  return hn::Sqrt(notBelow0(x));
}
HWY_INLINE F square(F x) {
  return hn::Mul(x, x);
}

/// A vector, point or colour in every lane.
struct F3 {
  F x, y, z;
};
using Point = F3;

HWY_INLINE F3 all3(const std::array<float, 3>& v) {
  return {all(v[0]), all(v[1]), all(v[2])};
}
HWY_INLINE F3 operator+(const F3& a, const F3& b) {
  return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}
HWY_INLINE F3 operator-(const F3& a, const F3& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
HWY_INLINE F3 operator*(const F3& a, const F3& b) {
  return {hn::Mul(a.x, b.x), hn::Mul(a.y, b.y), hn::Mul(a.z, b.z)};
}
HWY_INLINE F3 operator*(F s, const F3& v) {
  return {hn::Mul(s, v.x), hn::Mul(s, v.y), hn::Mul(s, v.z)};
}
HWY_INLINE F3 operator-(const F3& v) {
  return {hn::Neg(v.x), hn::Neg(v.y), hn::Neg(v.z)};
}
HWY_INLINE F dot(const F3& a, const F3& b) {
  return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z)));
}
HWY_INLINE F3 cross(const F3& a, const F3& b) {
  return {hn::MulSub(a.y, b.z, hn::Mul(a.z, b.y)), hn::MulSub(a.z, b.x, hn::Mul(a.x, b.z)),
          hn::MulSub(a.x, b.y, hn::Mul(a.y, b.x))};
}
HWY_INLINE F greatest(const F3& v) {
  return hn::Max(hn::Max(v.x, v.y), v.z);
}
HWY_INLINE F3 normalized(const F3& v) {
  return hn::Div(all(1.0F), hn::Sqrt(dot(v, v))) * v;
}
HWY_INLINE F3 select(M which, const F3& yes, const F3& no) {
  return {hn::IfThenElse(which, yes.x, no.x), hn::IfThenElse(which, yes.y, no.y),
          hn::IfThenElse(which, yes.z, no.z)};
}
HWY_INLINE F3 selectElseZero(M which, const F3& v) {
  return {hn::IfThenElseZero(which, v.x), hn::IfThenElseZero(which, v.y),
          hn::IfThenElseZero(which, v.z)};
}

/// Applies one row of an affine map.
HWY_INLINE F apply(const std::array<float, 4>& row, const F3& p) {
  return hn::MulAdd(all(row[0]), p.x,
                    hn::MulAdd(all(row[1]), p.y, hn::MulAdd(all(row[2]), p.z, all(row[3]))));
}
HWY_INLINE F3 mapPoint(const AffineRows& map, const F3& p) {
  return {apply(map[0], p), apply(map[1], p), apply(map[2], p)};
}
HWY_INLINE F3 mapDirection(const AffineRows& map, const F3& d) {
  const auto row = [&](const std::array<float, 4>& r) {
    return hn::MulAdd(all(r[0]), d.x, hn::MulAdd(all(r[1]), d.y, hn::Mul(all(r[2]), d.z)));
  };
  return {row(map[0]), row(map[1]), row(map[2])};
}

/// Bit mixer of 32 bits with low bias (the Hash Prospector project).
HWY_INLINE U mixBits(U x) {
  x = hn::Mul(hn::Xor(x, hn::ShiftRight<16>(x)), hn::Set(bits, 0x21f0aaadU));
  x = hn::Mul(hn::Xor(x, hn::ShiftRight<15>(x)), hn::Set(bits, 0x735a2d97U));
  return hn::Xor(x, hn::ShiftRight<15>(x));
}

/// Random numbers of a lane: hashes of a counter that starts at a seed.
HWY_INLINE U nextBits(U& counter) {
  counter = hn::Add(counter, hn::Set(bits, 0x9e3779b9U));
  return mixBits(counter);
}

/// (h + 1/2) / 2^32 for h < 2^31: as precise near 0 as 32 bits can be.
HWY_INLINE F fraction(U h) {
  const F x = hn::ConvertTo(floats, hn::BitCast(ints, h));
  return hn::MulAdd(x, all(0x1p-32F), all(0x1p-33F));
}

/// Uniform in (0, 1].
HWY_INLINE F uniformOf(U h) {
  const U top = hn::Set(bits, 0x80000000U);
  const F low = fraction(hn::AndNot(top, h));
  const auto upper = hn::RebindMask(floats, hn::Eq(hn::And(h, top), top));
  return hn::Add(low, hn::IfThenElseZero(upper, all(0.5F)));
}
HWY_INLINE F uniform(U& counter) {
  return uniformOf(nextBits(counter));
}

/// Polynomial in x by Horner's rule: coefficient of the highest power, then the lower ones.
HWY_INLINE F polynomial(F x, float highest, std::initializer_list<float> lower) {
  F sum = all(highest);
  for (const float coefficient : lower)
    sum = hn::MulAdd(sum, x, all(coefficient));
  return sum;
}

/// The logarithm of a positive number that is not subnormal, to a float's last place (the
/// polynomial of Cephes' logf).
HWY_INLINE F logOf(F x) {
  const I raw = hn::BitCast(ints, x);
  const I root = hn::Set(ints, 0x3f3504f3); // sqrt(1/2): mantissas lie in [root, 2 root)
  const I power = hn::ShiftRight<23>(hn::Sub(raw, root));
  const F mantissa = hn::BitCast(floats, hn::Sub(raw, hn::ShiftLeft<23>(power)));
  const F e = hn::ConvertTo(floats, power);
  const F f = hn::Sub(mantissa, all(1.0F));
  const F p =
      polynomial(f, 7.0376836292E-2F,
                 {-1.1514610310E-1F, 1.1676998740E-1F, -1.2420140846E-1F, 1.4249322787E-1F,
                  -1.6668057665E-1F, 2.0000714765E-1F, -2.4999993993E-1F, 3.3333331174E-1F});
  const F f2 = hn::Mul(f, f);
  F low = hn::Mul(hn::Mul(p, f), f2);
  low = hn::MulAdd(e, all(-2.12194440E-4F), low);
  low = hn::NegMulAdd(all(0.5F), f2, low);
  return hn::MulAdd(e, all(0.693359375F), hn::Add(f, low));
}

/// Exponential with mean 1, precise near 0 and in the tail: each half of the unit interval is
/// measured from its own end.
HWY_INLINE F exponential(U& counter) {
  const U h = nextBits(counter);
  const U top = hn::Set(bits, 0x80000000U);
  const F u = fraction(hn::AndNot(top, h)); // in (0, 1/2)
  const auto near = hn::RebindMask(floats, hn::Eq(hn::And(h, top), top));
  // -log(1 - u) where the exponential is small, -log(u) where it is large.
  const F one = all(1.0F);
  const F x = hn::IfThenElse(near, hn::Sub(one, u), u);
  const F lost = hn::IfThenElseZero(near, hn::Sub(hn::Sub(one, x), u)); // rounding error of 1 - u
  return hn::Neg(hn::Add(logOf(x), lost));
}

/// Cosine and sine of an angle in turns, 0 <= turns <= 1, to 1e-7: Taylor series about the nearest
/// multiple of a quarter turn.
struct CosineSine {
  F cosine, sine;
};
HWY_INLINE CosineSine ofTurns(F turns) {
  const F quarters = hn::Mul(turns, all(4.0F));
  const F nearest = hn::Floor(hn::Add(quarters, all(0.5F)));
  const F x = hn::Mul(hn::Sub(quarters, nearest), all(1.57079632679F));
  const F x2 = hn::Mul(x, x);
  const F cubic =
      polynomial(x2, 2.75573192e-6F, {-1.98412698e-4F, 8.33333333e-3F, -1.66666667e-1F});
  const F sine = hn::MulAdd(hn::Mul(x, x2), cubic, x);
  const F cosine = polynomial(x2, -2.75573192e-7F,
                              {2.48015873e-5F, -1.38888889e-3F, 4.16666667e-2F, -0.5F, 1.0F});
  const U quadrant = hn::BitCast(bits, hn::ConvertTo(ints, nearest));
  const U odd = hn::And(quadrant, hn::Set(bits, 1));
  const M swapped = hn::RebindMask(floats, hn::Eq(odd, hn::Set(bits, 1)));
  const U half = hn::And(quadrant, hn::Set(bits, 2));
  const U sineSign = hn::ShiftLeft<30>(half);
  const U cosineSign = hn::Xor(sineSign, hn::ShiftLeft<31>(odd));
  const auto signedBy = [](F value, U sign) {
    return hn::BitCast(floats, hn::Xor(hn::BitCast(bits, value), sign));
  };
  return {signedBy(hn::IfThenElse(swapped, sine, cosine), cosineSign),
          signedBy(hn::IfThenElse(swapped, cosine, sine), sineSign)};
}

/// A right-handed orthonormal frame around a unit normal (base/Vector.h's Frame).
struct Frames {
  F3 tangent, bitangent, normal;

  explicit HWY_INLINE Frames(const F3& n) : normal(n) {
    const F one = all(1.0F);
    const F sign = hn::CopySign(one, n.z);
    const F a = hn::Div(hn::Neg(one), hn::Add(sign, n.z));
    const F b = hn::Mul(hn::Mul(n.x, n.y), a);
    tangent = {hn::MulAdd(hn::Mul(sign, square(n.x)), a, one), hn::Mul(sign, b),
               hn::Neg(hn::Mul(sign, n.x))};
    bitangent = {b, hn::MulAdd(square(n.y), a, sign), hn::Neg(n.y)};
  }

  HWY_INLINE F3 toWorld(const F3& v) const {
    return v.x * tangent + v.y * bitangent + v.z * normal;
  }
  HWY_INLINE F3 toLocal(const F3& v) const {
    return {dot(v, tangent), dot(v, bitangent), dot(v, normal)};
  }
};

} // namespace fenestra::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
