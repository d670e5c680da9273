// Random numbers of samples, one a lane: base/Sampling.h, bit for bit. Compiled once for each
// instruction set: include after Highway's foreach_target.h.

#if defined(FENESTRA_SIMD_SAMPLER_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef FENESTRA_SIMD_SAMPLER_INL_H
#undef FENESTRA_SIMD_SAMPLER_INL_H
#else
#define FENESTRA_SIMD_SAMPLER_INL_H
#endif

#include "base/Sampling.h"
// After foreach_target.h:
#include "base/LaneMath-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fenestra::HWY_NAMESPACE {

/// The 32 leading bits of each number of a sample, in the order of NumberSource's words.
struct LaneNumbers {
  std::array<UInt, 2> position, flight, scattered, choices, rest;
};

/// NumberSource::numbers of `sample` in the stream (start, key).
HWY_INLINE LaneNumbers numbersOf(UInt start, UInt key, UInt sample, bool isStratified) {
  using Stream = NumberSource::Stream;
  constexpr int places = NumberSource::places;
  const auto at = [&](UInt n) { return mixBits((start + n * Stream::step) ^ key); };
  const UInt first = sample * Stream::each;
  const auto two = [&](std::uint32_t i) { return std::array{at(first + i), at(first + (i + 1))}; };
  LaneNumbers numbers{two(0), two(2), two(4), two(6), two(8)};
  if (!isStratified)
    return numbers;
  const UInt place = shiftRight<1>(sample) & NumberSource::elements;
  const UInt block = (sample - (place + place)) * Stream::each;
  std::uint32_t ofPair = NumberSource::ofBlock;
  for (std::array<UInt, 2>* words :
       {&numbers.position, &numbers.flight, &numbers.scattered, &numbers.choices}) {
    const UInt shuffle = at(block + ofPair++);
    const UInt factor = shuffle & NumberSource::elements;
    const UInt net =
        gather(NumberSource::nets.data(), bitsAsInt(factor * NumberSource::blockSize + place));
    const auto put = [&](UInt leading, UInt& word) {
      word = (leading & NumberSource::leading) ^ shiftRight<places>(word);
    };
    const UInt strata = net ^ shuffle;
    put(strata, (*words)[0]);
    put(shiftLeft<places>(strata), (*words)[1]);
  }
  return numbers;
}

/// Uniform in [0, 1): the 24 leading bits.
HWY_INLINE Float below1(UInt bits) {
  return toFloat(bitsAsInt(shiftRight<8>(bits))) * 0x1p-24F;
}

} // namespace fenestra::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
