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
  const auto at = [&](UInt n) { return streamWord(start, key, n); };
  const UInt first = firstWordOfSample(sample);
  const auto two = [&](std::uint32_t i) { return std::array{at(first + i), at(first + (i + 1))}; };
  SimdPrimarySamples numbers{two(0), two(2), two(4), two(6), two(8)};
  if (!isStratified)
    return numbers;
  const UInt index = indexInBlock(sample);
  std::uint32_t pair = 0;
  for (std::array<UInt, 2>* words :
       {&numbers.position, &numbers.collision, &numbers.direction, &numbers.choices}) {
    const UInt shuffle = at(wordOfShuffle(sample, index, pair++));
    const UInt strata =
        shuffle ^ gather(Sampler::nets.data(), bitsAsInt(placeInNets(shuffle, index)));
    (*words)[0] = replaceLeading(strata, (*words)[0]);
    (*words)[1] = replaceLeading(nextStrata(strata), (*words)[1]);
  }
  return numbers;
}

} // namespace fenestra::core::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
