#include "base/AliasTables.h"

namespace fenestra {

void AliasTables::append(std::span<const double> cumulative) {
  const std::uint64_t full = std::uint64_t{1} << (32 - bits);
  std::vector<std::uint64_t> remaining(size(), 0); // of each bin, to be placed
  std::vector<std::size_t> underfull, overfull;    // less than a place full, and the others
  std::uint64_t previous = 0;
  for (std::size_t i = 0; i < size(); ++i) {
    if (i + 1 < cumulative.size()) {
      // Rounded sums' differences add up to 2^32: the places are filled without a remainder.
      const auto sum = static_cast<std::uint64_t>(0x1p32 * cumulative[i + 1] + 0.5);
      remaining[i] = sum - previous;
      previous = sum;
    }
    (remaining[i] < full ? underfull : overfull).push_back(i);
  }
  const std::size_t first = slots.size();
  const auto fill = [&](std::size_t place, std::size_t alias) {
    slots[first + place] = {static_cast<float>(remaining[place]), static_cast<float>(alias)};
  };
  slots.resize(first + size());
  while (!underfull.empty() && !overfull.empty()) {
    const std::size_t slot = underfull.back(), donor = overfull.back();
    underfull.pop_back();
    fill(slot, donor);
    remaining[donor] -= full - remaining[slot];
    if (remaining[donor] < full) {
      overfull.pop_back();
      underfull.push_back(donor);
    }
  }
  for (const std::size_t slot : overfull) // exactly full
    fill(slot, slot);
}

} // namespace fenestra
