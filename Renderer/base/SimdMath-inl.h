// SIMD math: 3D arithmetic, random numbers, angles, and moving lanes within a vector. Compiled once
// per instruction set: include after Highway's foreach_target.h.

#if defined(FENESTRA_SIMD_MATH_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef FENESTRA_SIMD_MATH_INL_H
#undef FENESTRA_SIMD_MATH_INL_H
#else
#define FENESTRA_SIMD_MATH_INL_H
#endif

#include "base/ScalarMath.h"
#include "base/Simd-inl.h"

#include <initializer_list>

HWY_BEFORE_NAMESPACE();
namespace fenestra::core::HWY_NAMESPACE {

using Real = float; ///< the type of one lane of Float

HWY_INLINE float abs(float x) {
  return std::abs(x);
}
/// True with the given probability, for uniform numbers in (0, 1].
HWY_INLINE LaneMask sampleBernoulli(float probability, Float uniform) {
  return uniform <= probability;
}
HWY_INLINE bool isAllEqual(float x, float value) {
  return x == value;
}
HWY_INLINE bool isAllEqual(Float x, float value) {
  return !(~(x == value)).any();
}

#include "base/VectorFormulas-inl.h"

HWY_INLINE Float3 flipIfNegative(float x, const Float3& v) {
  return x < 0.0F ? -v : v;
}

/// Applies one row of an affine map.
HWY_INLINE Float applyRow(const std::array<float, 4>& row, const Float3& p) {
  return fma(row[0], p.x, fma(row[1], p.y, fma(row[2], p.z, row[3])));
}
HWY_INLINE Float3 mapPoint(const AffineRows& map, const Float3& p) {
  return {applyRow(map[0], p), applyRow(map[1], p), applyRow(map[2], p)};
}
HWY_INLINE Float3 mapDirection(const AffineRows& map, const Float3& d) {
  const auto row = [&](const std::array<float, 4>& r) {
    return fma(r[0], d.x, fma(r[1], d.y, r[2] * d.z));
  };
  return {row(map[0]), row(map[1]), row(map[2])};
}

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

/// mixBits32 of base/Random.h.
HWY_INLINE UInt mixBits(UInt x) {
  x = (x ^ shiftRight<16>(x)) * 0x21f0aaadU;
  x = (x ^ shiftRight<15>(x)) * 0x735a2d97U;
  return x ^ shiftRight<15>(x);
}

/// Random bits per lane: hashes of a counter that starts at a seed.
HWY_INLINE UInt nextBits(UInt& counter) {
  counter = counter + 0x9e3779b9U;
  return mixBits(counter);
}

/// (h + 1/2) / 2^32 for h < 2^31: as precise near 0 as 32 bits allow.
HWY_INLINE Float toFraction(UInt h) {
  return fma(toFloat(bitsAsInt(h)), 0x1p-32F, 0x1p-33F);
}

/// Half of the unit interval that random bits select, and the position in it.
struct SplitUniform {
  LaneMask upper;
  Float low; ///< in (0, 1/2)
};
HWY_INLINE SplitUniform splitUniform(UInt h) {
  return {bitsAsInt(h) < 0, toFraction(h & 0x7fffffffU)};
}

/// Uniform in (0, 1].
HWY_INLINE Float toUniform(UInt h) {
  const SplitUniform u = splitUniform(h);
  return u.low + zeroUnless(u.upper, 0.5F);
}
HWY_INLINE Float uniform(UInt& counter) {
  return toUniform(nextBits(counter));
}

/// Polynomial in x by Horner's rule: coefficient of the highest power, then the lower ones.
HWY_INLINE Float polynomial(Float x, float highest, std::initializer_list<float> lower) {
  Float sum = highest;
  for (const float coefficient : lower)
    sum = fma(sum, x, coefficient);
  return sum;
}

/// Logarithm of a positive normal number, accurate to a float's last digit (polynomial of Cephes'
/// logf).
HWY_INLINE Float log(Float x) {
  const Int raw = bitsAsInt(x);
  // 0x3f3504f3 is sqrt(1/2) as bits: mantissas lie in [sqrt(1/2), sqrt(2)).
  const Int power = shiftRight<23>(raw - 0x3f3504f3);
  const Float f = bitsAsFloat(raw - shiftLeft<23>(power)) - 1.0F;
  const Float e = toFloat(power);
  const Float p =
      polynomial(f, 7.0376836292E-2F,
                 {-1.1514610310E-1F, 1.1676998740E-1F, -1.2420140846E-1F, 1.4249322787E-1F,
                  -1.6668057665E-1F, 2.0000714765E-1F, -2.4999993993E-1F, 3.3333331174E-1F});
  const Float f2 = f * f; // below: log 2 = 0.693359375 - 2.12194440E-4
  const Float low = fnma(0.5F, f2, fma(e, -2.12194440E-4F, p * f * f2));
  return fma(e, 0.693359375F, f + low);
}

/// Exponential variate of mean 1, precise near 0 and in the tail: each half of the unit interval is
/// measured from its own end.
HWY_INLINE Float toExponential(UInt h) {
  const SplitUniform u = splitUniform(h);
  // -log(1 - u) where the exponential is small, -log(u) where it is large.
  const Float x = select(u.upper, 1.0F - u.low, u.low);
  const Float lost = zeroUnless(u.upper, 1.0F - x - u.low); // rounding error of 1 - u
  return -(log(x) + lost);
}
HWY_INLINE Float exponential(UInt& counter) {
  return toExponential(nextBits(counter));
}

/// Cosine and sine of an angle in turns, 0 <= turns <= 1, to 1e-7: Taylor series about the nearest
/// multiple of a quarter turn.
HWY_INLINE CosineSine cosSinTurns(Float turns) {
  const Float quarters = turns * 4.0F;
  const Float nearest = floor(quarters + 0.5F);
  const Float x = (quarters - nearest) * 1.57079632679F;
  const Float x2 = x * x;
  const Float cubic =
      polynomial(x2, 2.75573192e-6F, {-1.98412698e-4F, 8.33333333e-3F, -1.66666667e-1F});
  const Float sine = fma(x * x2, cubic, x);
  const Float cosine = polynomial(x2, -2.75573192e-7F,
                                  {2.48015873e-5F, -1.38888889e-3F, 4.16666667e-2F, -0.5F, 1.0F});
  const UInt quadrant = bitsAsUInt(toInt(nearest));
  const UInt odd = quadrant & 1U;
  const LaneMask swapped = odd == 1U;
  const UInt sineSign = shiftLeft<30>(quadrant & 2U);
  const UInt cosineSign = sineSign ^ shiftLeft<31>(odd);
  const auto applySign = [](Float value, UInt sign) {
    return bitsAsFloat(bitsAsUInt(value) ^ sign);
  };
  return {applySign(select(swapped, sine, cosine), cosineSign),
          applySign(select(swapped, cosine, sine), sineSign)};
}

/// Angle of the point (x, y) in turns from the x axis, in [-1/2, 1/2], to 1e-7; 0 at the origin.
HWY_INLINE Float angleInTurns(Float x, Float y) {
  const Float minor = min(abs(x), abs(y));
  const Float major = max(abs(x), abs(y));
  const Float q = minor / max(major, std::numeric_limits<float>::min());
  // Minimax polynomial of atan(q) / (2 pi q), with a relative error of 1.5e-8.
  const Float octant =
      q * polynomial(q * q, 4.535739899e-4F,
                     {-2.557401608e-3F, 6.794566131e-3F, -1.194345555e-2F, 1.693557243e-2F,
                      -2.260580226e-2F, 3.181924202e-2F, -5.305123391e-2F, 1.591549407e-1F});
  const Float quadrant = select(abs(y) > abs(x), 0.25F - octant, octant);
  return copySign(select(x < 0.0F, 0.5F - quadrant, quadrant), y);
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
