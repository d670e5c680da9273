#include "clip/portable/SmoothFill.h"

#include "clip/portable/FillLevel.h"

namespace fenestra::core {

namespace {

FillLevel makeFinestLevel(const FillGrid& grid) {
  FillLevel level{FillAxis(grid.x), FillAxis(grid.y)};
  std::size_t sample = 0;
  for (std::size_t row = 0; row < level.rows(); ++row)
    for (std::size_t column = 0; column < level.columns(); ++column, ++sample)
      if (grid.isKnown[sample] != 0)
        level.set(column, row, grid.depths[sample], 1.0f);
      else
        level.set(column, row, 0.0f, 0.0f);
  return level;
}

/// Adds `factor` times the far surface to the depths that are known, or to all.
void addFarSurface(FillGrid& grid, const FarSurface& far, float factor, bool isKnownOnly,
                   const ParallelLoop& loop) {
  const std::size_t columns = grid.x.size();
  loop(grid.y.size(), 1 + 4096 / columns, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row)
      for (std::size_t column = 0; column < columns; ++column)
        if (const std::size_t at = row * columns + column; !isKnownOnly || grid.isKnown[at] != 0)
          grid.depths[at] += factor * static_cast<float>(far(grid.x[column], grid.y[row]));
  });
}

void fillNear(FillGrid& grid, double reach, const ParallelLoop& loop) {
  std::vector<FillLevel> levels;
  levels.push_back(makeFinestLevel(grid));
  levels.back().trimFocus();
  levels.back().extendBoundary(reach);
  // Coarser levels would not resolve the bending of the plate.
  while (!levels.back().isSmall() && levels.back().pitch() < 0.5 * reach)
    levels.push_back(levels.back().coarsen());
  constexpr int minSteps = 24;       // at the finest level
  constexpr int coarsestSteps = 128; // so that its error is small against that of its pitch
  levels.back().relax(reach, coarsestSteps, loop);
  for (std::size_t i = levels.size() - 1; i-- > 0;) {
    levels[i].prolongate(levels[i + 1], loop);
    levels[i].relax(reach, minSteps << i, loop);
  }
  const FillLevel& level = levels.front();
  std::size_t sample = 0;
  for (std::size_t row = 0; row < level.rows(); ++row)
    for (std::size_t column = 0; column < level.columns(); ++column, ++sample)
      if (level.isFree(column, row))
        grid.depths[sample] = level.depth(column, row);
}

} // namespace

void fillSmoothly(FillGrid& grid, const FarSurface& far, double length, const ParallelLoop& loop) {
  addFarSurface(grid, far, -1.0f, true, loop);
  fillNear(grid, nearFraction * length, loop);
  addFarSurface(grid, far, 1.0f, false, loop);
}

} // namespace fenestra::core
