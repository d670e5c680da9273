#include "base/Distribution.h"

#include <algorithm>
#include <numeric>

namespace fenestra {

Distribution Distribution::of(std::vector<double> values) {
  if (values.empty())
    return {};
  std::ranges::sort(values);
  const auto count = static_cast<double>(values.size());
  return {std::accumulate(values.begin(), values.end(), 0.0) / count,
          values[static_cast<std::size_t>(0.95 * (count - 1.0))], values.back()};
}

} // namespace fenestra
