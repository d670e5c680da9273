#pragma once
// A pixel's sums as 64-bit words, for checkpoint files.

#include "image/Film.h"

#include <array>
#include <bit>

namespace fenestra::core {

inline constexpr std::size_t wordsPerPixel = 30;

using PixelWords = std::array<std::uint64_t, wordsPerPixel>;

/// Calls each(number) for all numbers of a pixel, in the order of the words. Excludes blockSize and
/// isDeterministic, which follow from the film and the scene.
template <typename Sums, typename Each>
void forEachNumber(Sums& p, Each&& each) {
  const auto colors = [&](auto& color) {
    for (int c = 0; c < 3; ++c)
      each(color[c]);
  };
  each(p.samples);
  colors(p.mean);
  colors(p.m2);
  each(p.alpha);
  each(p.depth);
  each(p.collidedSamples);
  colors(p.albedo);
  colors(p.normal);
  each(p.scatterings);
  colors(p.evenMean);
  each(p.evenAlpha);
  colors(p.partialSums[0]);
  colors(p.partialSums[1]);
  colors(p.blockM2);
}

inline PixelWords toWords(const PixelSums& pixel) {
  PixelWords words = {};
  std::size_t i = 0;
  forEachNumber(pixel,
                [&](const auto& number) { words[i++] = std::bit_cast<std::uint64_t>(number); });
  return words;
}

inline void fromWords(const PixelWords& words, PixelSums& pixel) {
  std::size_t i = 0;
  forEachNumber(
      pixel, [&]<typename Number>(Number& number) { number = std::bit_cast<Number>(words[i++]); });
}

} // namespace fenestra::core
