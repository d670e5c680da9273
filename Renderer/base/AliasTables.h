#pragma once
// Discrete distributions that lanes draw from: one random word, one look-up.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace fenestra {

/// Draws bins by one random word each, without a search (Walker 1977; Vose 1991, in whole numbers):
/// the word's low bits choose one of 2^bits places; the rest, below height(), is compared
/// with the place's threshold: below it the bin of the place's own number is drawn, else the other
/// one. Probabilities are whole multiples of 2^-32, 0 where they are 0. All numbers of a place are
/// exact in float.
struct AliasTables {
  struct Slot {
    float threshold, alias;
  };
  /// Least number: what is left of a word has 24 bits then.
  static constexpr int minBits = 8;

  int bits = minBits;
  std::vector<Slot> slots; ///< one table behind the other

  explicit AliasTables(std::size_t bins) {
    while (std::size_t{1} << bits < bins)
      ++bits;
  }
  std::size_t size() const { return std::size_t{1} << bits; }
  float thresholdRange() const { return static_cast<float>(std::uint32_t{1} << (32 - bits)); }
  /// Appends a table. `cumulative`: 0, then sums of the bins' probabilities, the last of them 1;
  /// or 0 throughout, for bins that are never drawn.
  void append(std::span<const double> cumulative);
};

} // namespace fenestra
