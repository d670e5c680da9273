#include "base/AliasTables.h"

namespace fenestra::core {

void AliasTables::append(std::span<const double> cumulative) {
  const std::uint64_t full = std::uint64_t{1} << (32 - bits); // capacity of a slot
  std::vector<std::uint64_t> remaining(size(), 0); // probability per bin that has no slot yet
  std::vector<std::size_t> underfull, overfull; // bins with less than a full slot, and the others
  std::uint64_t previous = 0;
  for (std::size_t i = 0; i < size(); ++i) {
    if (i + 1 < cumulative.size()) {
      // Differences of rounded sums add up to exactly 2^32, so the slots fill without a remainder.
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

} // namespace fenestra::core
