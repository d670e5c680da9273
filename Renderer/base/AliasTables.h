#pragma once
// Discrete distributions for SIMD sampling: one random word and one table look-up per sample.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace fenestra::core {

/// Alias method (Walker 1977; Vose 1991) in integer arithmetic. The low bits of a random word
/// select one of 2^bits slots. The remaining bits, a number below thresholdRange(), are compared
/// with the slot's threshold: below it the slot's own bin is sampled, otherwise its alias.
/// Probabilities are multiples of 2^-32, and 0 exactly where the bin's is 0. All values of a slot
/// are exact in float.
struct AliasTables {
  struct Slot {
    float threshold, alias;
  };
  /// Minimum, so that the remaining bits of a word fit into the 24 bits of a float.
  static constexpr int minBits = 8;

  int bits = minBits;
  std::vector<Slot> slots; ///< tables, one after the other

  explicit AliasTables(std::size_t bins) {
    while (std::size_t{1} << bits < bins)
      ++bits;
  }
  std::size_t size() const { return std::size_t{1} << bits; }
  float thresholdRange() const { return static_cast<float>(std::uint32_t{1} << (32 - bits)); }
  /// Appends a table. `cumulative`: 0, then the cumulative probabilities of the bins up to 1; or
  /// all zeros, for bins that are never sampled.
  void append(std::span<const double> cumulative);
};

} // namespace fenestra::core
