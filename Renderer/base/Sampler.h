#pragma once
// Random numbers of a path as a function of (seed, pixel, sample). The few that cause most of its
// noise are stratified over the pixel's samples, or independent.

#include "base/Random.h"
#include "base/ScalarMath.h"

#include <array>

namespace fenestra::core {

enum class Sampling {
  stratified, ///< the first dimensions are stratified over blocks of a pixel's samples
  independent ///< no two samples are correlated
};

constexpr const char* toString(Sampling sampling) {
  return sampling == Sampling::stratified ? "stratified" : "independent";
}

/// Random bits of one sample, independent of each other: the eight numbers that contribute most to
/// the noise, and the seed of all others.
struct PrimarySamples {
  std::uint64_t position;     ///< in the pixel: toUniform2
  std::uint64_t opticalDepth; ///< to the camera ray's first tentative collision: toUniform
  std::uint64_t acceptance;   ///< whether that collision is real: toUniform
  std::uint64_t direction;    ///< the first scattered direction: toUniform2
  /// Whether the first collision is at a surface, and the light sampled there: toUniform2.
  std::uint64_t choices;
  std::uint64_t pathSeed;
};

/// Stratifies blocks of `blockSize` samples of one half buffer (a pixel's samples of even, or of
/// odd, index). In each block, each of the eight numbers has one sample in each of blockSize equal
/// strata. Each pair (position; depth and acceptance; direction; choices) is a (0, 3, 2)-net in
/// base 2 (Hammersley's; Niederreiter 1992, chapter 3). Blocks, and thereby the half buffers, are
/// independent of each other.
///
/// A sample's index in its block is an element of GF(blockSize). It is multiplied by a random
/// element per pair, so that the strata of one pair are independent of another's. Then a random
/// element is added to each number's strata, so that all strata are equally likely, whatever the
/// index and the other numbers are.
class Sampler {
public:
  static constexpr bool hasIndependentHalfBuffers = true;
  static constexpr std::uint32_t blockSize = 8; ///< samples; formulas/Random.inl has masks for it

  Sampler(Sampling sampling, std::uint64_t seed)
      : m_seed(Random(seed, 0, 0).bits()), m_isStratified(sampling == Sampling::stratified) {}

  /// Number of samples of a half buffer that depend on each other.
  std::uint32_t samplesPerBlock() const { return m_isStratified ? blockSize : 1; }

  bool isStratified() const { return m_isStratified; }

  /// Words for up to `maxSamples` successive samples of a pixel: hashes of a counter and a key.
  struct Stream {
    static constexpr std::uint32_t maxSamples = std::uint32_t{1} << 27;

    std::uint32_t start, key;

    std::uint32_t at(std::uint32_t n) const { return scalar::streamWord(start, key, n); }
  };

  /// Stream that contains a sample, at index `sample` % Stream::maxSamples.
  Stream stream(std::uint64_t pixel, std::uint64_t sample) const {
    const std::uint64_t bits =
        mixBits(mixBits(m_seed + pixel * Random::gamma) + sample / Stream::maxSamples);
    return {static_cast<std::uint32_t>(bits >> 32), static_cast<std::uint32_t>(bits)};
  }

  PrimarySamples generate(std::uint64_t pixel, std::uint64_t sample) const {
    return generate(stream(pixel, sample), static_cast<std::uint32_t>(sample % Stream::maxSamples));
  }

  /// Sample at index `sample` of a stream. base/SimdSampler-inl.h computes the same in SIMD lanes.
  PrimarySamples generate(const Stream& stream, std::uint32_t sample) const {
    Words words;
    for (std::uint32_t i = 0; i < words.size(); ++i)
      words[i] = stream.at(scalar::firstWordOfSample(sample) + i);
    if (m_isStratified)
      stratify(stream, sample, words);
    const auto toUInt64 = [&](std::size_t high, std::size_t low) {
      return std::uint64_t{words[high]} << 32 | words[low];
    };
    return {toUInt64(0, 1), toUInt64(2, 10), toUInt64(3, 11),
            toUInt64(4, 5), toUInt64(6, 7),  toUInt64(8, 9)};
  }

  /// Strata of a pair, at blockSize * factor + index: the product of elements `index` and `factor`
  /// modulo x^3 + x + 1 in a word's leading bits, followed by the product's bits in reverse order.
  /// Factor 0 counts as 1.
  using Nets = std::array<std::uint32_t, blockSize * blockSize>;
  static const Nets nets;

private:
  /// Hashes of a sample, in the order of formulas/Random.inl.
  using Words = std::array<std::uint32_t, 12>;

  /// Replaces the leading bits of each number by its stratum.
  static void stratify(const Stream& stream, std::uint32_t sample, Words& words) {
    const std::uint32_t index = scalar::indexInBlock(sample);
    for (std::uint32_t pair = 0; pair < 4; ++pair) {
      const std::uint32_t shuffle = stream.at(scalar::wordOfShuffle(sample, index, pair));
      const std::uint32_t strata = nets[scalar::placeInNets(shuffle, index)] ^ shuffle;
      std::uint32_t* const word = &words[2 * pair];
      word[0] = scalar::replaceLeading(strata, word[0]);
      word[1] = scalar::replaceLeading(scalar::nextStrata(strata), word[1]);
    }
  }

  static constexpr Nets makeNets() {
    Nets nets = {};
    for (std::uint32_t factor = 0; factor < blockSize; ++factor)
      for (std::uint32_t index = 0; index < blockSize; ++index) {
        std::uint32_t product = 0;
        std::uint32_t shifted = factor > 0 ? factor : 1;
        for (unsigned i = 0; i < 3; ++i) {
          product ^= index >> i & 1 ? shifted : 0;
          shifted = shifted << 1 ^ (shifted > 3 ? 0b1011 : 0);
        }
        const std::uint32_t reversed = (product & 1) << 2 | (product & 2) | product >> 2;
        nets[blockSize * factor + index] = product << 29 | reversed << 26;
      }
    return nets;
  }

  std::uint64_t m_seed;
  bool m_isStratified;
};

inline constexpr Sampler::Nets Sampler::nets = Sampler::makeNets();

} // namespace fenestra::core
