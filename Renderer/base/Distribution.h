#pragma once

#include <vector>

namespace fenestra {

/// Mean, 95th percentile and maximum of some values, in the values' unit.
struct Distribution {
  double mean = 0.0, p95 = 0.0, max = 0.0;

  static Distribution of(std::vector<double> values); ///< 0 for no values
};

} // namespace fenestra
