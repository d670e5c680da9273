#pragma once

#include <cstddef>
#include <cstdint>

namespace fenestra::core::gpu {

/// Sizes of a lane's work. They do not affect the image.
struct LaneLimits {
  std::uint32_t threads;         ///< on the device; a multiple of 64
  std::size_t paths;             ///< per batch
  std::int32_t maxSteps = 65536; ///< of a thread per dispatch; fewer if a dispatch takes long
};

} // namespace fenestra::core::gpu
