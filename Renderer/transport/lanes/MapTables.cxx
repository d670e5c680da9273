#include "transport/lanes/MapTables.h"

namespace fenestra {

bool MapTables::serves(const EnvironmentSampler& sampler) {
  constexpr double brightest = 1e20, darkest = 1e-20;
  constexpr int longest = 1 << 14; // texels: places of columns and rows keep digits in float
  const EnvironmentMap& map = sampler.light().map;
  const double whole = sampler.integral();
  return sampler.isConstant() || (std::max(map.width, map.height) <= longest &&
                                  (whole == 0.0 || (whole > darkest && whole < brightest)));
}

MapTables::MapTables(const EnvironmentSampler& sampler, double mapPmf)
    : width(sampler.light().map.width),
      height(sampler.light().map.height),
      rgb(sampler.light().map.rgb.data()),
      tint(narrow3(sampler.light().radiance)),
      pmf(narrow(mapPmf)),
      perBrightness(narrow(mapPmf / sampler.integral())),
      rows(static_cast<std::size_t>(height)),
      columns(static_cast<std::size_t>(width)) {
  rows.append(sampler.rowCdf());
  columns.slots.reserve(columns.size() * static_cast<std::size_t>(height));
  for (int row = 0; row < height; ++row)
    columns.append(sampler.columnCdf(row));
  for (int row = 0; row <= (height + 1) / 2; ++row) {
    const double sine = std::sin(0.5 * pi * row / height);
    falls.push_back(narrow(2.0 * sine * sine));
  }
}

} // namespace fenestra
