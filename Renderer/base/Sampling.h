#pragma once
// Random numbers of a sample as a function of (seed, pixel, sample): the few that decide most of a
// path's noise stratified over samples of the pixel, or independent.

#include "base/Random.h"

#include <array>

namespace fenestra {

enum class Sampling {
  strata,     ///< a pixel's samples share out the first numbers, block by block
  independent ///< no two samples share anything
};

constexpr const char* nameOf(Sampling sampling) {
  return sampling == Sampling::strata ? "strata" : "independent";
}

/// Random bits of one sample, independent of each other: six numbers that decide most, and the seed
/// of all others.
struct SampleNumbers {
  std::uint64_t position;          ///< in the pixel: uniform2Of
  std::uint64_t depth, acceptance; ///< optical depth to the eye ray's first tentative collision,
                                   ///< and whether that one is real: uniformOf
  std::uint64_t scattered;         ///< the first scattered direction: uniform2Of
  std::uint64_t rest;
};

/// Strata lie in blocks of `blockSize` samples of one half, the pixel's samples of even or of odd
/// index: of each of the six numbers a block has one sample in each of blockSize equal strata, and
/// of each pair (position; depth and acceptance; direction) one in each of the boxes that are a
/// power of two wide and high and hold as much (Hammersley's net; Niederreiter 1992, chapter 3).
/// Blocks, and with them the halves, are independent of each other.
///
/// A sample's place in its block is an element of the field of blockSize elements. It is multiplied
/// by a random element for each pair, so that one pair's strata tell nothing of another's; then the
/// strata of each number are shifted by adding a random element, so that each is as likely as any
/// other whatever the place and the other numbers are.
class NumberSource {
public:
  static constexpr bool hasIndependentHalves = true;
  static constexpr std::uint32_t blockSize = 8; ///< samples

  NumberSource(Sampling sampling, std::uint64_t seed)
      : m_seed(Random(seed, 0, 0).bits()), m_isStratified(sampling == Sampling::strata) {}

  /// Samples of a half that depend on each other.
  std::uint32_t block() const { return m_isStratified ? blockSize : 1; }

  SampleNumbers numbers(std::uint64_t pixel, std::uint64_t sample) const {
    const Stream stream{mixBits(m_seed + pixel * Random::gamma)};
    constexpr std::uint64_t each = 8; // numbers of a sample, five of use
    const std::uint64_t first = each * sample;
    SampleNumbers numbers{stream.at(first), stream.at(first + 1), stream.at(first + 2),
                          stream.at(first + 3), stream.at(first + 4)};
    if (m_isStratified)
      stratify(stream, sample, numbers);
    return numbers;
  }

private:
  static constexpr unsigned places = 3;                    ///< binary places of a stratum
  static constexpr std::uint64_t elements = blockSize - 1; ///< mask
  /// Leading places of both halves of 64 bits.
  static constexpr std::uint64_t leading = elements << 61 | elements << 29;

  /// Numbers of a pixel.
  struct Stream {
    std::uint64_t start;
    std::uint64_t at(std::uint64_t n) const { return mixBits(start + n * Random::gamma); }
  };

  /// Strata of a pair, in the leading places of both halves of 64 bits: element `place` times
  /// element `factor` modulo x^3 + x + 1, and in the low half its places in reverse order. Factor 0
  /// stands for 1.
  using Nets = std::array<std::array<std::uint64_t, blockSize>, blockSize>;
  static constexpr Nets makeNets() {
    Nets nets = {};
    for (std::uint64_t factor = 0; factor < blockSize; ++factor)
      for (std::uint64_t place = 0; place < blockSize; ++place) {
        std::uint64_t product = 0;
        std::uint64_t shifted = factor > 0 ? factor : 1;
        for (unsigned i = 0; i < places; ++i) {
          product ^= place >> i & 1 ? shifted : 0;
          shifted = shifted << 1 ^ (shifted > 3 ? 0b1011 : 0);
        }
        const std::uint64_t reversed = (product & 1) << 2 | (product & 2) | product >> 2;
        nets[factor][place] = product << 61 | reversed << 29;
      }
    return nets;
  }

  /// Replaces leading bits by strata.
  static void stratify(const Stream& stream, std::uint64_t sample, SampleNumbers& numbers) {
    static constexpr Nets nets = makeNets();
    constexpr std::uint64_t aside = std::uint64_t{1} << 63; // far from every sample's numbers
    const std::uint64_t half = sample % 2;
    const std::uint64_t place = sample / 2 % blockSize;
    const std::uint64_t block = sample / (2 * blockSize);
    const std::uint64_t ofBlock = stream.at(aside + 2 * block + half);
    const auto strataOf = [&](unsigned pair) {
      return nets[ofBlock >> (places * pair) & elements][place] ^
             (ofBlock << (places * pair) & leading);
    };
    const auto inside = [](std::uint64_t bits) { return bits >> places & ~leading; };
    numbers.position = strataOf(0) | inside(numbers.position);
    numbers.scattered = strataOf(1) | inside(numbers.scattered);
    const std::uint64_t flight = strataOf(2);
    numbers.depth = (flight & elements << 61) | numbers.depth >> places;
    numbers.acceptance = flight << 32 | numbers.acceptance >> places;
  }

  std::uint64_t m_seed;
  bool m_isStratified;
};

} // namespace fenestra
