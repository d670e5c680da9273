// SIMD math: the formulas of formulas/README.md for the lanes of a vector, and moving lanes within
// it. Compiled once per instruction set: include after Highway's foreach_target.h.

#if defined(FENESTRA_SIMD_MATH_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef FENESTRA_SIMD_MATH_INL_H
#undef FENESTRA_SIMD_MATH_INL_H
#else
#define FENESTRA_SIMD_MATH_INL_H
#endif

#include "base/Formulas.h"
#include "base/Simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fenestra::core::HWY_NAMESPACE {

using Real = float; ///< the type of one lane of Float

CONSTANT Real infiniteReal = std::numeric_limits<Real>::infinity();
CONSTANT Real tinyReal = std::numeric_limits<Real>::min();

HWY_INLINE LaneMask noLanes() {
  return LaneMask::none();
}
HWY_INLINE LaneMask allLanes() {
  return ~LaneMask::none();
}
HWY_INLINE bool isAny(LaneMask m) {
  return m.any();
}
HWY_INLINE LaneMask both(LaneMask a, LaneMask b) {
  return a & b;
}
HWY_INLINE LaneMask either(LaneMask a, LaneMask b) {
  return a | b;
}
HWY_INLINE LaneMask without(LaneMask a, LaneMask b) {
  return a.without(b);
}
/// True with the given probability, for uniform numbers in (0, 1].
HWY_INLINE LaneMask sampleBernoulli(float probability, Float uniform) {
  return uniform <= probability;
}
HWY_INLINE bool isAllEqual(Float x, float value) {
  return !(~(x == value)).any();
}

#include "base/Float3-inl.h"
#include "formulas/Random.inl"
#include "formulas/Vectors.inl"
// Uses vectors:
#include "formulas/Uniforms.inl"

/// Loads a vector per lane from three arrays, starting at index i.
template <typename Columns>
HWY_INLINE Float3 load3(const Columns& columns, std::size_t i) {
  return {load(&columns[0][i]), load(&columns[1][i]), load(&columns[2][i])};
}
template <typename Columns>
HWY_INLINE void store3(const Float3& v, Columns& columns, std::size_t i) {
  store(v.x, &columns[0][i]);
  store(v.y, &columns[1][i]);
  store(v.z, &columns[2][i]);
}

/// Random bits per lane: hashes of a counter that starts at a seed.
HWY_INLINE UInt nextBits(UInt& counter) {
  counter = nextCounter(counter);
  return mixBits(counter);
}
HWY_INLINE Float uniform(UInt& counter) {
  return toUniform(nextBits(counter));
}
HWY_INLINE Float exponential(UInt& counter) {
  return toExponential(nextBits(counter));
}

/// Permutes the lanes of a vector.
class Shuffle {
public:
  /// Moves the lanes of `which` to the front, in order; the lanes behind them are undefined.
  static HWY_INLINE Shuffle compress(LaneMask which) {
#if HWY_TARGET <= HWY_AVX3 // has an instruction: no table needed
    return Shuffle(Int(hn::Compress(hn::Iota(ints, 0), which.cast(ints))));
#else
    return Shuffle(promote({lanePackTable[which.bits()]}));
#endif
  }
  /// Moves the first lanes to the lanes of `which`, in order.
  static HWY_INLINE Shuffle expand(LaneMask which) {
    const std::uint64_t set = which.bits();
    if constexpr (laneCount <= 8)
      return Shuffle(promote({laneRankTable[set]}));
    constexpr std::uint64_t everyByte = 0x0101010101010101U;
    const std::uint64_t low = set & 0xff;
    const auto before = static_cast<std::uint64_t>(std::popcount(low));
    return Shuffle(promote({laneRankTable[low], laneRankTable[set >> 8] + everyByte * before}));
  }

  template <typename N>
  HWY_INLINE N operator()(N numbers) const {
    return hn::TableLookupLanes(numbers.v, hn::IndicesFromVec(typename N::Tag(), m_indices.v));
  }
  HWY_INLINE Float3 operator()(const Float3& v) const {
    return {(*this)(v.x), (*this)(v.y), (*this)(v.z)};
  }
  /// Lane from which each lane takes its value.
  HWY_INLINE Int indices() const {
    return m_indices;
  }

private:
  explicit HWY_INLINE Shuffle(Int indices) : m_indices(indices) {}
  static HWY_INLINE Int promote(const std::array<std::uint64_t, 2>& bytesOfLanes) {
    constexpr hn::Rebind<std::uint8_t, Floats> bytes;
    return hn::PromoteTo(ints,
                         hn::LoadU(bytes, reinterpret_cast<const std::uint8_t*>(&bytesOfLanes)));
  }

  Int m_indices;
};

} // namespace fenestra::core::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
