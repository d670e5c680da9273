#pragma once
// Random numbers of a sample as a function of (seed, pixel, sample): the few that decide most of a
// path's noise stratified over samples of the pixel, or independent.

#include "base/Random.h"

#include <array>

namespace fenestra {

enum class Sampling {
  stratified, ///< a pixel's samples share out the first numbers, block by block
  independent ///< no two samples share anything
};

constexpr const char* toString(Sampling sampling) {
  return sampling == Sampling::stratified ? "strata" : "independent";
}

/// Random bits of one sample, independent of each other: eight numbers that decide most, and the
/// seed of all others.
struct PrimarySamples {
  std::uint64_t position;                 ///< in the pixel: toUniform2
  std::uint64_t opticalDepth, acceptance; ///< optical depth to the eye ray's first tentative
                                          ///< collision, and whether that one is real: toUniform
  std::uint64_t direction; ///< the first scattered direction: toUniform2
  std::uint64_t choices;   ///< whether the first collision is a surface's, and the light
                           ///< that is looked at there: toUniform2
  std::uint64_t pathSeed;
};

/// Strata lie in blocks of `blockSize` samples of one half, the pixel's samples of even or of odd
/// index: of each of the eight numbers a block has one sample in each of blockSize equal strata,
/// and of each pair (position; depth and acceptance; direction; choices) one in each of the boxes
/// that are a power of two wide and high and hold as much (Hammersley's net; Niederreiter 1992,
/// chapter 3). Blocks, and with them the halves, are independent of each other.
///
/// A sample's place in its block is an element of the field of blockSize elements. It is multiplied
/// by a random element for each pair, so that one pair's strata tell nothing of another's; then the
/// strata of each number are shifted by adding a random element, so that each is as likely as any
/// other whatever the place and the other numbers are.
class Sampler {
public:
  static constexpr bool hasIndependentHalfBuffers = true;
  static constexpr std::uint32_t blockSize = 8; ///< samples

  Sampler(Sampling sampling, std::uint64_t seed)
      : m_seed(Random(seed, 0, 0).bits()), m_isStratified(sampling == Sampling::stratified) {}

  /// Samples of a half that depend on each other.
  std::uint32_t samplesPerBlock() const { return m_isStratified ? blockSize : 1; }

  bool isStratified() const { return m_isStratified; }

  /// Words for up to `samples` successive samples of a pixel: hashes of a counter and a key.
  struct Stream {
    static constexpr std::uint32_t maxSamples = std::uint32_t{1} << 27;
    static constexpr std::uint32_t wordsPerSample = 16; ///< words of a sample
    static constexpr std::uint32_t step = 0x9e3779b9U;

    std::uint32_t start, key;

    std::uint32_t at(std::uint32_t n) const { return mixBits32((start + n * step) ^ key); }
  };

  /// Stream of a sample, which is number `sample` % Stream::samples in there.
  Stream stream(std::uint64_t pixel, std::uint64_t sample) const {
    const std::uint64_t bits =
        mixBits(mixBits(m_seed + pixel * Random::gamma) + sample / Stream::maxSamples);
    return {static_cast<std::uint32_t>(bits >> 32), static_cast<std::uint32_t>(bits)};
  }

  PrimarySamples generate(std::uint64_t pixel, std::uint64_t sample) const {
    return generate(stream(pixel, sample), static_cast<std::uint32_t>(sample % Stream::maxSamples));
  }

  /// Numbers of sample number `sample` of a stream. base/SimdSampler-inl.h draws the same in lanes.
  PrimarySamples generate(const Stream& stream, std::uint32_t sample) const {
    Words words;
    for (std::uint32_t i = 0; i < words.size(); ++i)
      words[i] = stream.at(Stream::wordsPerSample * sample + i);
    if (m_isStratified)
      stratify(stream, sample, words);
    const auto toUInt64 = [&](std::size_t high, std::size_t low) {
      return std::uint64_t{words[high]} << 32 | words[low];
    };
    return {toUInt64(0, 1), toUInt64(2, 10), toUInt64(3, 11),
            toUInt64(4, 5), toUInt64(6, 7),  toUInt64(8, 9)};
  }

  static constexpr unsigned strataBits = 3;                   ///< binary places of a stratum
  static constexpr std::uint32_t elementMask = blockSize - 1; ///< mask
  static constexpr std::uint32_t leadingMask = elementMask
                                               << (32 - strataBits); ///< places of a word
  static constexpr std::uint32_t pairs = 4;
  /// Index of the first of the words that shuffle a block's strata, one a pair, among those of the
  /// block's first sample.
  static constexpr std::uint32_t shuffleWords = Stream::wordsPerSample - pairs;

  /// Strata of a pair, at blockSize * factor + place: element `place` times element `factor` modulo
  /// x^3 + x + 1 in a word's leading places, and behind them its places in reverse order. Factor 0
  /// stands for 1.
  using Nets = std::array<std::uint32_t, blockSize * blockSize>;
  static const Nets nets;

private:
  /// Hashes of a sample: position (0, 1), depth, acceptance, direction (4, 5), choices (6, 7), rest
  /// (8, 9), and the less significant bits of depth and acceptance, which lanes leave out.
  using Words = std::array<std::uint32_t, shuffleWords>;

  /// Replaces leading bits by strata.
  static void stratify(const Stream& stream, std::uint32_t sample, Words& words) {
    const std::uint32_t index = sample / 2 % blockSize;
    const std::uint32_t block = Stream::wordsPerSample * (sample - 2 * index) + shuffleWords;
    for (std::uint32_t pair = 0; pair < pairs; ++pair) {
      const std::uint32_t shuffle = stream.at(block + pair);
      const std::uint32_t net = nets[blockSize * (shuffle & elementMask) + index];
      const auto replaceLeading = [&](std::uint32_t strata, std::uint32_t& word) {
        word = (strata & leadingMask) | word >> strataBits;
      };
      replaceLeading(net ^ shuffle, words[2 * pair]);
      replaceLeading((net ^ shuffle) << strataBits, words[2 * pair + 1]);
    }
  }

  static constexpr Nets makeNets() {
    Nets nets = {};
    for (std::uint32_t factor = 0; factor < blockSize; ++factor)
      for (std::uint32_t index = 0; index < blockSize; ++index) {
        std::uint32_t product = 0;
        std::uint32_t shifted = factor > 0 ? factor : 1;
        for (unsigned i = 0; i < strataBits; ++i) {
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

} // namespace fenestra
