#include "clip/surface/SmoothFill.h"

#include "clip/surface/FillLevel.h"

namespace fenestra::core {

namespace {

FillLevel makeFinestLevel(const DepthBuffer& buffer, const std::vector<Region>& regions) {
  FillLevel level(FillAxis(buffer.xAxis().coordinates()), FillAxis(buffer.yAxis().coordinates()));
  std::size_t sample = 0;
  for (std::size_t row = 0; row < level.rows(); ++row)
    for (std::size_t column = 0; column < level.columns(); ++column, ++sample)
      if (regions[sample] == Region::focus)
        level.set(column, row, buffer.depthsFromReference()[sample], 1.0f);
      else
        level.set(column, row, 0.0f, 0.0f);
  return level;
}

} // namespace

void fillSmoothly(DepthBuffer& buffer, const std::vector<Region>& regions, double length) {
  std::vector<FillLevel> levels;
  levels.push_back(makeFinestLevel(buffer, regions));
  levels.back().trimFocus();
  levels.back().extendBoundary(length);
  // Coarser levels would not resolve the bending of the plate.
  while (!levels.back().isSmall() &&
         (levels.back().pitch() < 0.25 * length || !levels.back().isSolvable()))
    levels.push_back(levels.back().coarsen());
  constexpr int minSteps = 24; // at the finest level
  levels.back().solve(length);
  for (std::size_t i = levels.size() - 1; i-- > 0;) {
    levels[i].prolongate(levels[i + 1]);
    levels[i].relax(length, minSteps << i);
  }
  const FillLevel& level = levels.front();
  std::int64_t sample = 0;
  for (std::size_t row = 0; row < level.rows(); ++row)
    for (std::size_t column = 0; column < level.columns(); ++column, ++sample)
      if (level.isFree(column, row))
        buffer.set(sample, buffer.reference() + level.depth(column, row));
}

} // namespace fenestra::core
