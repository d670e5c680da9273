#pragma once
// Properties of samples that decide how they are stored.

#include "base/Vector.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

namespace fenestra {

/// Range and kind of samples. Doubles suffice: they hold every integer of 32 bits exactly.
struct SampleSurvey {
  double least = infinity, greatest = -infinity; ///< range of the finite samples
  bool whole = true;                             ///< all finite samples are whole numbers
  std::size_t notANumber = 0, infinite = 0;

  bool finite() const { return notANumber + infinite == 0; }

  void add(const SampleSurvey& more) {
    least = std::min(least, more.least);
    greatest = std::max(greatest, more.greatest);
    whole = whole && more.whole;
    notANumber += more.notANumber;
    infinite += more.infinite;
  }
};

template <typename T>
SampleSurvey survey(std::span<const T> samples) {
  SampleSurvey s;
  T least = std::numeric_limits<T>::max();
  T greatest = std::numeric_limits<T>::lowest();
  for (const T x : samples) {
    if constexpr (std::is_floating_point_v<T>) {
      if (!std::isfinite(x)) {
        ++(std::isnan(x) ? s.notANumber : s.infinite);
        continue;
      }
      s.whole = s.whole && x == std::trunc(x);
    }
    least = std::min(least, x);
    greatest = std::max(greatest, x);
  }
  if (s.notANumber + s.infinite < samples.size()) {
    s.least = static_cast<double>(least);
    s.greatest = static_cast<double>(greatest);
  }
  return s;
}

} // namespace fenestra
