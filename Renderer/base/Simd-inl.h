// SIMD types with operators, so that SIMD code reads like scalar arithmetic: Float, Int and UInt
// hold a number per lane, LaneMask a bool. Scalar operands apply to every lane. Only fma(), fms()
// and fnma() fuse a multiplication with an addition. Compiled once per instruction set: include
// after Highway's foreach_target.h.

#if defined(FENESTRA_SIMD_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef FENESTRA_SIMD_INL_H
#undef FENESTRA_SIMD_INL_H
#else
#define FENESTRA_SIMD_INL_H
#endif

#include "base/Narrow.h"
#include "base/SimdTables.h"

#include <array>
#include <bit>
#include <concepts>
#include <cstdint>
#include <cstring>

#include <hwy/cache_control.h>
#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace fenestra::core::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::ScalableTag<float>;
using Ints = hn::RebindToSigned<Floats>;
using UInts = hn::RebindToUnsigned<Floats>;
inline constexpr Floats floats{};
inline constexpr Ints ints{};
inline constexpr UInts uints{};

inline constexpr std::size_t laneCount = hn::MaxLanes(floats);

/// True or false per lane.
struct LaneMask {
  hn::Mask<Floats> m;

  LaneMask() = default;
  /// Converts a mask of any vector type.
  template <typename Mask>
  HWY_INLINE LaneMask(Mask mask) : m(hn::RebindMask(floats, mask)) {}
  /// The first n lanes, or all if there are fewer.
  static HWY_INLINE LaneMask first(std::size_t n) { return hn::FirstN(floats, n); }
  static HWY_INLINE LaneMask none() { return first(0); }
  /// Lane i from bit i.
  static HWY_INLINE LaneMask fromBits(std::uint64_t packed) {
    return hn::LoadMaskBits(floats, reinterpret_cast<const std::uint8_t*>(&packed));
  }

  HWY_INLINE std::uint64_t bits() const {
    std::uint64_t packed = 0;
    hn::StoreMaskBits(floats, m, reinterpret_cast<std::uint8_t*>(&packed));
    return packed;
  }
  HWY_INLINE bool any() const { return !hn::AllFalse(floats, m); }
  HWY_INLINE std::size_t count() const { return hn::CountTrue(floats, m); }
  HWY_INLINE LaneMask without(LaneMask other) const { return hn::AndNot(other.m, m); }
  HWY_INLINE LaneMask operator&(LaneMask other) const { return hn::And(m, other.m); }
  HWY_INLINE LaneMask operator|(LaneMask other) const { return hn::Or(m, other.m); }
  HWY_INLINE LaneMask operator~() const { return hn::Not(m); }
  /// Mask for vectors of another type.
  template <typename Tag>
  HWY_INLINE auto cast(Tag tag) const {
    return hn::RebindMask(tag, m);
  }
};

/// A number of the scalar type T per lane.
template <typename T>
struct Simd {
  using Tag = hn::Rebind<T, Floats>;
  using Vector = hn::Vec<Tag>;

  Vector v;

  Simd() = default;
  HWY_INLINE Simd(Vector x) : v(x) {}
  template <std::same_as<T> X> // no implicit conversion of other scalar types
  HWY_INLINE Simd(X x) : v(hn::Set(Tag(), x)) {}

  HWY_INLINE void setIf(LaneMask m, Simd value) { v = hn::IfThenElse(m.cast(Tag()), value.v, v); }
  HWY_INLINE Simd operator-() const { return hn::Neg(v); }
  friend HWY_INLINE Simd operator+(Simd a, Simd b) { return hn::Add(a.v, b.v); }
  friend HWY_INLINE Simd operator-(Simd a, Simd b) { return hn::Sub(a.v, b.v); }
  friend HWY_INLINE Simd operator*(Simd a, Simd b) { return hn::Mul(a.v, b.v); }
  friend HWY_INLINE Simd operator/(Simd a, Simd b) { return hn::Div(a.v, b.v); }
  friend HWY_INLINE Simd operator&(Simd a, Simd b) { return hn::And(a.v, b.v); }
  friend HWY_INLINE Simd operator^(Simd a, Simd b) { return hn::Xor(a.v, b.v); }
  friend HWY_INLINE LaneMask operator<(Simd a, Simd b) { return hn::Lt(a.v, b.v); }
  friend HWY_INLINE LaneMask operator<=(Simd a, Simd b) { return hn::Le(a.v, b.v); }
  friend HWY_INLINE LaneMask operator>(Simd a, Simd b) { return hn::Gt(a.v, b.v); }
  friend HWY_INLINE LaneMask operator>=(Simd a, Simd b) { return hn::Ge(a.v, b.v); }
  friend HWY_INLINE LaneMask operator==(Simd a, Simd b) { return hn::Eq(a.v, b.v); }
  /// Returns b in lanes where a or b is NaN.
  friend HWY_INLINE Simd min(Simd a, Simd b) { return hn::Min(a.v, b.v); }
  /// Returns b in lanes where a or b is NaN.
  friend HWY_INLINE Simd max(Simd a, Simd b) { return hn::Max(a.v, b.v); }
};

using Float = Simd<float>;
using Int = Simd<std::int32_t>;
using UInt = Simd<std::uint32_t>; ///< bits, and integers modulo 2^32

template <int by, typename T>
HWY_INLINE Simd<T> shiftLeft(Simd<T> x) {
  return hn::ShiftLeft<by>(x.v);
}
/// Shifts of Int are arithmetic: the sign stays.
template <int by, typename T>
HWY_INLINE Simd<T> shiftRight(Simd<T> x) {
  return hn::ShiftRight<by>(x.v);
}

/// Shifts by the same number of bits in every lane.
template <typename T>
HWY_INLINE Simd<T> shiftLeft(Simd<T> x, int by) {
  return hn::ShiftLeftSame(x.v, by);
}
template <typename T>
HWY_INLINE Simd<T> shiftRight(Simd<T> x, int by) {
  return hn::ShiftRightSame(x.v, by);
}

HWY_INLINE Float select(LaneMask m, Float yes, Float no) {
  return hn::IfThenElse(m.m, yes.v, no.v);
}
HWY_INLINE Int select(LaneMask m, Int yes, Int no) {
  return hn::IfThenElse(m.cast(ints), yes.v, no.v);
}
HWY_INLINE Float zeroUnless(LaneMask m, Float yes) {
  return hn::IfThenElseZero(m.m, yes.v);
}
HWY_INLINE UInt zeroUnless(LaneMask m, UInt yes) {
  return hn::IfThenElseZero(m.cast(uints), yes.v);
}
HWY_INLINE Int zeroUnless(LaneMask m, Int yes) {
  return hn::IfThenElseZero(m.cast(ints), yes.v);
}

/// a b + c, rounded once if the instruction set supports it.
HWY_INLINE Float fma(Float a, Float b, Float c) {
  return hn::MulAdd(a.v, b.v, c.v);
}
/// a b - c.
HWY_INLINE Float fms(Float a, Float b, Float c) {
  return hn::MulSub(a.v, b.v, c.v);
}
/// c - a b.
HWY_INLINE Float fnma(Float a, Float b, Float c) {
  return hn::NegMulAdd(a.v, b.v, c.v);
}
HWY_INLINE Float abs(Float x) {
  return hn::Abs(x.v);
}
HWY_INLINE Float sqrt(Float x) {
  return hn::Sqrt(x.v);
}
HWY_INLINE Float floor(Float x) {
  return hn::Floor(x.v);
}
/// e^x.
HWY_INLINE Float exp(Float x) {
  return hn::Exp(floats, x.v);
}
/// e^x - 1, precise near 0.
HWY_INLINE Float expm1(Float x) {
  return hn::Expm1(floats, x.v);
}
HWY_INLINE Float copySign(Float magnitude, Float sign) {
  return hn::CopySign(magnitude.v, sign.v);
}

HWY_INLINE Float toFloat(Int x) {
  return hn::ConvertTo(floats, x.v);
}
/// Converts integers from 0 to 2^23 - 1.
HWY_INLINE Int nonNegativeToInt(Float x) {
  constexpr float shift = 0x1p23F; // moves the number to the mantissa's lowest bits
  return Int(hn::BitCast(ints, (x + shift).v)) & 0x7fffff;
}
/// Rounds toward 0.
HWY_INLINE Int toInt(Float x) {
  return hn::ConvertTo(ints, x.v);
}
/// Reinterprets the bits of a number as another type.
template <typename T>
HWY_INLINE Float bitsAsFloat(Simd<T> x) {
  return hn::BitCast(floats, x.v);
}
template <typename T>
HWY_INLINE Int bitsAsInt(Simd<T> x) {
  return hn::BitCast(ints, x.v);
}
template <typename T>
HWY_INLINE UInt bitsAsUInt(Simd<T> x) {
  return hn::BitCast(uints, x.v);
}

template <typename T>
HWY_INLINE Simd<T> load(const T* from) {
  return hn::LoadU(typename Simd<T>::Tag(), from);
}
template <typename T>
HWY_INLINE void store(Simd<T> x, T* to) {
  hn::StoreU(x.v, typename Simd<T>::Tag(), to);
}
template <typename T>
HWY_INLINE Simd<T> gather(const T* memory, Int index) {
  return hn::GatherIndex(typename Simd<T>::Tag(), memory, index.v);
}

/// One number per lane, in memory, for work lane by lane.
template <typename T>
struct alignas(64) LaneArray : std::array<T, laneCount> {
  LaneArray() = default;
  template <typename N>
  explicit HWY_INLINE LaneArray(N numbers) {
    hn::Store(numbers.v, typename N::Tag(), this->data());
  }
};

/// Array indices, one per lane. Unsigned, so that they serve as addresses without sign extension.
struct Indices : LaneArray<std::uint32_t> {
  explicit HWY_INLINE Indices(Int notNegative) : LaneArray(bitsAsUInt(notNegative)) {}
};

/// Reads a scalar, aligned or not.
template <typename Number>
HWY_INLINE Number loadScalar(const void* memory) {
  Number number;
  std::memcpy(&number, memory, sizeof(number));
  return number;
}

#if HWY_TARGET != HWY_SCALAR
/// loadEach for few numbers. A fold: a loop, unrolled too late, would move lanes through memory.
template <typename Number, std::size_t step, typename Element, std::size_t... i>
HWY_INLINE auto loadFew(const Element* memory, const std::uint32_t* index,
                        std::index_sequence<i...>) {
  auto numbers = hn::Zero(hn::CappedTag<Number, sizeof...(i)>());
  ((numbers = hn::InsertLane(numbers, i, loadScalar<Number>(memory + index[step * i]))), ...);
  return numbers;
}

/// Loads `count` numbers, aligned or not, at every `step`-th index. With the indices in registers,
/// single loads are as fast as gather instructions, or faster.
template <typename Number, std::size_t count, std::size_t step, typename Element>
HWY_INLINE auto loadEach(const Element* memory, const std::uint32_t* index) {
  if constexpr (count * sizeof(Number) > 16)
    return hn::Combine(hn::CappedTag<Number, count>(),
                       loadEach<Number, count / 2, step>(memory, index + step * count / 2),
                       loadEach<Number, count / 2, step>(memory, index));
  else
    return loadFew<Number, step>(memory, index, std::make_index_sequence<count>());
}
#endif

/// Loads 32 bits at memory[i] for each i.
template <typename Element>
HWY_INLINE Int loadInts(const Element* memory, const Indices& index) {
#if HWY_TARGET == HWY_SCALAR
  return loadScalar<std::int32_t>(memory + index[0]);
#else
  return loadEach<std::int32_t, laneCount, 1>(memory, index.data());
#endif
}

/// Two floats per lane, adjacent in memory.
struct Pairs {
  Float first, second;
};

/// Loads 64 bits at memory[i] for each i.
template <typename Element>
HWY_INLINE Pairs loadPairs(const Element* memory, const Indices& index) {
#if HWY_TARGET == HWY_SCALAR
  const auto both = loadScalar<std::array<float, 2>>(memory + index[0]);
  return {both[0], both[1]};
#else
  constexpr std::size_t half = laneCount / 2;
  const Float::Vector even =
      hn::BitCast(floats, loadEach<std::int64_t, half, 2>(memory, index.data()));
  const Float::Vector odd =
      hn::BitCast(floats, loadEach<std::int64_t, half, 2>(memory, index.data() + 1));
  return {hn::OddEven(hn::DupEven(odd), even), hn::OddEven(odd, hn::DupOdd(even))};
#endif
}

/// Calls visit(lane) for every lane of `which`.
template <typename Visit>
HWY_INLINE void forEachLane(LaneMask which, Visit&& visit) {
  for (std::uint64_t left = which.bits(); left != 0; left &= left - 1)
    visit(static_cast<std::size_t>(std::countr_zero(left)));
}

} // namespace fenestra::core::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
