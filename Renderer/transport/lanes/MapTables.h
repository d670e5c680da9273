#pragma once
// Environment maps in the form that lanes draw from and look up.

#include "base/Narrow.h"
#include "model/lights/EnvironmentSampler.h"

#include <span>

namespace fenestra {

/// Draws bins by one random word each, without a search (Walker 1977; Vose 1991, in whole numbers):
/// the word's low bits choose one of 2^bits places; the rest, below height(), is compared
/// with the place's threshold: below it the bin of the place's own number is drawn, else the other
/// one. Probabilities are whole multiples of 2^-32, 0 where they are 0. All numbers of a place are
/// exact in float.
struct AliasTables {
  struct Place {
    float threshold, other;
  };
  /// Least number: what is left of a word has 24 bits then.
  static constexpr int leastBits = 8;

  int bits = leastBits;
  std::vector<Place> places; ///< one table behind the other

  explicit AliasTables(std::size_t bins) {
    while (std::size_t{1} << bits < bins)
      ++bits;
  }
  std::size_t size() const { return std::size_t{1} << bits; }
  float height() const { return static_cast<float>(std::uint32_t{1} << (32 - bits)); }
  /// Appends a table. `cumulative`: 0, then sums of the bins' probabilities, the last of them 1;
  /// or 0 throughout, for bins that are never drawn.
  void append(std::span<const double> cumulative);
};

/// EnvironmentSampler of a map, in float.
struct MapTables {
  std::int32_t width, height;
  const float* rgb; ///< of the texels, row by row; the map's own
  std::array<float, 3> tint;
  float share;         ///< probability that LightSet::sample() takes this map
  float perBrightness; ///< density of that, per steradian, of a radiance of brightness 1
  AliasTables rows;
  AliasTables columns; ///< a table for each row
  /// 1 - cos of the angle from the nearer pole to the upper edge of its i-th row.
  std::vector<float> falls;

  /// True if floats suffice.
  static bool serves(const EnvironmentSampler& sampler);

  /// A view: the sampler must outlive the object. Not of a constant, nor of a black map.
  MapTables(const EnvironmentSampler& sampler, double shareOfMap);
};

} // namespace fenestra
