#include "base/AliasTables.h"

namespace fenestra {

void AliasTables::append(std::span<const double> cumulative) {
  const std::uint64_t full = std::uint64_t{1} << (32 - bits);
  std::vector<std::uint64_t> left(size(), 0); // of each bin, to be placed
  std::vector<std::size_t> poor, rich;        // less than a place full, and the others
  std::uint64_t before = 0;
  for (std::size_t i = 0; i < size(); ++i) {
    if (i + 1 < cumulative.size()) {
      // Rounded sums' differences add up to 2^32: the places are filled without a remainder.
      const auto sum = static_cast<std::uint64_t>(0x1p32 * cumulative[i + 1] + 0.5);
      left[i] = sum - before;
      before = sum;
    }
    (left[i] < full ? poor : rich).push_back(i);
  }
  const std::size_t first = places.size();
  const auto fill = [&](std::size_t place, std::size_t other) {
    places[first + place] = {static_cast<float>(left[place]), static_cast<float>(other)};
  };
  places.resize(first + size());
  while (!poor.empty() && !rich.empty()) {
    const std::size_t place = poor.back(), giver = rich.back();
    poor.pop_back();
    fill(place, giver);
    left[giver] -= full - left[place];
    if (left[giver] < full) {
      rich.pop_back();
      poor.push_back(giver);
    }
  }
  for (const std::size_t place : rich) // exactly full
    fill(place, place);
}

} // namespace fenestra
