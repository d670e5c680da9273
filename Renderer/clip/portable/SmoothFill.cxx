#include "clip/portable/SmoothFill.h"

#include "clip/portable/FillLevel.h"

namespace fenestra::core {

namespace {

/// Calls function(sample, column, row, depth of the far surface) for each sample.
template <typename Function>
void forEachSample(const FillGrid& grid, const FarSurface& far, const ParallelLoop& loop,
                   const Function& function) {
  const std::size_t columns = grid.x.size();
  loop(grid.y.size(), 1 + 4096 / columns, [&](std::size_t begin, std::size_t end) {
    std::vector<float> depths;
    for (std::size_t row = begin; row < end; ++row) {
      far.findRow(grid.x, grid.y[row], depths);
      for (std::size_t column = 0; column < columns; ++column)
        function(row * columns + column, column, row, depths[column]);
    }
  });
}

/// Solves for the near surface at the free samples.
void solveNear(std::vector<FillLevel>& levels, double reach, const ParallelLoop& loop) {
  levels.front().trimFocus();
  levels.front().extendBoundary(reach);
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
}

} // namespace

void fillSmoothly(FillGrid& grid, const FarSurface& far, double length, const ParallelLoop& loop) {
  std::vector<FillLevel> levels;
  levels.emplace_back(FillAxis(grid.x), FillAxis(grid.y));
  forEachSample(grid, far, loop,
                [&](std::size_t sample, std::size_t column, std::size_t row, float depth) {
                  const bool isKnown = grid.isKnown[sample] != 0;
                  levels.front().set(column, row, isKnown ? grid.depths[sample] - depth : 0.0f,
                                     isKnown ? 1.0f : 0.0f);
                });
  solveNear(levels, nearFraction * length, loop);
  forEachSample(grid, far, loop,
                [&](std::size_t sample, std::size_t column, std::size_t row, float depth) {
                  if (grid.isKnown[sample] == 0)
                    grid.depths[sample] = levels.front().depth(column, row) + depth;
                });
}

} // namespace fenestra::core
