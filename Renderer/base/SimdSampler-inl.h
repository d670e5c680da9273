// SIMD version of base/Sampler.h, one sample per lane, with the same bits. Compiled once per
// instruction set: include after Highway's foreach_target.h.

#if defined(FENESTRA_SIMD_SAMPLER_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef FENESTRA_SIMD_SAMPLER_INL_H
#undef FENESTRA_SIMD_SAMPLER_INL_H
#else
#define FENESTRA_SIMD_SAMPLER_INL_H
#endif

#include "base/Sampler.h"
// After foreach_target.h:
#include "base/SimdMath-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fenestra::core::HWY_NAMESPACE {

/// The 32 leading bits of each of the PrimarySamples, in the order of Sampler's words.
struct SimdPrimarySamples {
  std::array<UInt, 2> position, collision, direction, choices, pathSeed;
};

/// Sampler::generate for `sample` in the stream (start, key).
HWY_INLINE SimdPrimarySamples generateSamples(UInt start, UInt key, UInt sample,
                                              bool isStratified) {
  using Stream = Sampler::Stream;
  constexpr int strataBits = Sampler::strataBits;
  const auto at = [&](UInt n) { return mixBits((start + n * Stream::step) ^ key); };
  const UInt first = sample * Stream::wordsPerSample; // word of the stream
  const auto two = [&](std::uint32_t i) { return std::array{at(first + i), at(first + (i + 1))}; };
  SimdPrimarySamples numbers{two(0), two(2), two(4), two(6), two(8)};
  if (!isStratified)
    return numbers;
  const UInt index = shiftRight<1>(sample) & Sampler::elementMask;
  const UInt block = (sample - (index + index)) * Stream::wordsPerSample;
  std::uint32_t pairWord = Sampler::shuffleWords;
  for (std::array<UInt, 2>* words :
       {&numbers.position, &numbers.collision, &numbers.direction, &numbers.choices}) {
    const UInt shuffle = at(block + pairWord++);
    const UInt factor = shuffle & Sampler::elementMask;
    const UInt net = gather(Sampler::nets.data(), bitsAsInt(factor * Sampler::blockSize + index));
    const auto replaceLeading = [&](UInt leading, UInt& word) {
      word = (leading & Sampler::leadingMask) ^ shiftRight<strataBits>(word);
    };
    const UInt strata = net ^ shuffle;
    replaceLeading(strata, (*words)[0]);
    replaceLeading(shiftLeft<strataBits>(strata), (*words)[1]);
  }
  return numbers;
}

/// Uniform in [0, 1), from the 24 leading bits.
HWY_INLINE Float toUniformBelow1(UInt bits) {
  return toFloat(bitsAsInt(shiftRight<8>(bits))) * 0x1p-24F;
}

} // namespace fenestra::core::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
