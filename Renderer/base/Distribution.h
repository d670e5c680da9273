#pragma once

#include <algorithm>
#include <numeric>
#include <ranges>
#include <vector>

namespace fenestra::core {

/// Mean, 95th percentile and maximum of values, in their unit; 0 if there are none.
struct Distribution {
  double mean = 0.0, p95 = 0.0, max = 0.0;

  static Distribution compute(std::vector<double> values) {
    if (values.empty())
      return {};
    std::ranges::sort(values);
    const auto count = static_cast<double>(values.size());
    return {std::accumulate(values.begin(), values.end(), 0.0) / count,
            values[static_cast<std::size_t>(0.95 * (count - 1.0))], values.back()};
  }
};

/// Median, the upper one of an even number. Reorders the values; there must be one.
template <std::ranges::random_access_range Values>
auto findMedian(Values&& values) {
  const auto middle = std::ranges::begin(values) + std::ranges::ssize(values) / 2;
  std::ranges::nth_element(values, middle);
  return *middle;
}

} // namespace fenestra::core
