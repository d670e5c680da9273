#pragma once

#include <cstddef>
#include <cstdint>

namespace fenestra::core::gpu {

/// Sizes of the batches of a BatchTracer. They do not affect the image.
struct BatchLimits {
  std::uint32_t threads;         ///< on the device; a multiple of 64
  std::size_t paths;             ///< per batch
  std::int32_t maxSteps = 65536; ///< of a thread per dispatch; fewer if a dispatch takes long
};

} // namespace fenestra::core::gpu
