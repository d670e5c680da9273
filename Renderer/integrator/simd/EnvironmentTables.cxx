#include "integrator/simd/EnvironmentTables.h"

namespace fenestra::core {

bool EnvironmentTables::isSupported(const EnvironmentSampler& sampler) {
  constexpr double maxTotal = 1e20, minTotal = 1e-20;
  constexpr int maxTexels = 1 << 14; // texels: positions in rows and columns stay precise in float
  const EnvironmentMap& map = sampler.light().map;
  const double total = sampler.integral();
  return sampler.isConstant() || (std::max(map.width, map.height) <= maxTexels &&
                                  (total == 0.0 || (total > minTotal && total < maxTotal)));
}

EnvironmentTables::EnvironmentTables(const EnvironmentSampler& sampler, double mapPmf)
    : width(sampler.light().map.width),
      height(sampler.light().map.height),
      rgb(sampler.light().map.rgb.data()),
      tint(narrow3(sampler.light().radiance)),
      pmf(narrow(mapPmf)),
      pdfPerBrightness(narrow(mapPmf / sampler.integral())),
      rows(static_cast<std::size_t>(height)),
      columns(static_cast<std::size_t>(width)) {
  rows.append(sampler.rowCdf());
  columns.slots.reserve(columns.size() * static_cast<std::size_t>(height));
  for (int row = 0; row < height; ++row)
    columns.append(sampler.columnCdf(row));
  for (int row = 0; row <= (height + 1) / 2; ++row) {
    const double sine = std::sin(0.5 * pi * row / height);
    oneMinusCos.push_back(narrow(2.0 * sine * sine));
  }
}

} // namespace fenestra::core
