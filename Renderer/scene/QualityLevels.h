#pragma once
// Levels of quality: limits that stop a render.

#include <cstdint>

namespace fenestra::core {

struct QualityLevel {
  const char* name;
  std::uint64_t samples;
  double noise; ///< 0: not limited
};

inline constexpr QualityLevel qualityLevels[] = {
    {"draft", 16, 0.0}, {"normal", 256, 0.05}, {"high", 1024, 0.025}, {"final", 4096, 0.015}};

} // namespace fenestra::core
