#pragma once
// Environment maps in the form that SIMD code samples and evaluates.

#include "base/AliasTables.h"
#include "base/Narrow.h"
#include "model/lights/EnvironmentSampler.h"

#include <vector>

namespace fenestra::core {

/// EnvironmentSampler of a map, in float. Its CDFs become alias tables.
struct EnvironmentTables {
  std::int32_t width, height;
  const float* rgb; ///< texels of the map itself, row by row
  std::array<float, 3> tint;
  float pmf;              ///< probability that LightSet::sample() selects this map
  float pdfPerBrightness; ///< pdf of sampling it, per steradian, per brightness of a radiance
  AliasTables rows;
  AliasTables columns; ///< one table per row
  /// 1 - cos of the angle between the nearer pole and the upper edge of its i-th row.
  std::vector<float> oneMinusCos;

  /// True if float precision suffices.
  static bool isSupported(const EnvironmentSampler& sampler);

  /// Non-owning: the sampler must outlive the object. Its map is neither constant nor black.
  EnvironmentTables(const EnvironmentSampler& sampler, double mapPmf);
};

} // namespace fenestra::core
