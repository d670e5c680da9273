#pragma once
// Environment maps in the form that lanes draw from and look up.

#include "base/AliasTables.h"
#include "base/Narrow.h"
#include "model/lights/EnvironmentSampler.h"

#include <vector>

namespace fenestra {

/// EnvironmentSampler of a map, in float.
struct EnvironmentTables {
  std::int32_t width, height;
  const float* rgb; ///< of the texels, row by row; the map's own
  std::array<float, 3> tint;
  float pmf;              ///< probability that LightSet::sample() takes this map
  float pdfPerBrightness; ///< density of that, per steradian, of a radiance of brightness 1
  AliasTables rows;
  AliasTables columns; ///< a table for each row
  /// 1 - cos of the angle from the nearer pole to the upper edge of its i-th row.
  std::vector<float> oneMinusCos;

  /// True if floats suffice.
  static bool isSupported(const EnvironmentSampler& sampler);

  /// A view: the sampler must outlive the object. Not of a constant, nor of a black map.
  EnvironmentTables(const EnvironmentSampler& sampler, double mapPmf);
};

} // namespace fenestra
