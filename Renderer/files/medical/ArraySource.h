#pragma once
// Samples in a caller's memory as the source of a SampleStore, as if they were read from a file.

#include "base/Vector.h"
#include "files/medical/SampleSource.h"

namespace fenestra::core {

/// Samples of three axes. `steps`: bytes from a sample to the next one along each axis; any sign.
struct SampleArray {
  const char* data = nullptr; ///< the sample at index (0, 0, 0)
  SampleType type = {};
  Size3 size = Size3::Zero(), steps = Size3::Zero();
  bool isSwapped = false; ///< byte order differs from the machine's
};

/// Source of the samples, x fastest. They must outlive it.
SampleSource makeArraySource(const SampleArray& array);

} // namespace fenestra::core
