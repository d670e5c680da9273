#include "model/masks/Distances.h"

#include "model/masks/Rows.h"

#include <algorithm>
#include <cmath>

namespace fenestra::core {
namespace {

/// Squared distances along rows to the nearest marked voxel, limited to `most`.
std::vector<float> computeRowDistances(const Marks& marks, const Grid& grid, float most) {
  const auto step = static_cast<float>(grid.spacing().x());
  const auto count = static_cast<std::size_t>(grid.size.x());
  std::vector<float> squared(marks.size());
  forEachRow(grid.size, [&](std::int64_t, std::int64_t, std::size_t row) {
    float away = most;
    for (std::size_t i = row; i < row + count; ++i)
      squared[i] = away = marks[i] ? 0.0F : std::min(most, away + step);
    away = most;
    for (std::size_t i = row + count; i-- > row;) {
      away = marks[i] ? 0.0F : std::min(most, away + step);
      const float least = std::min(squared[i], away);
      squared[i] = least * least;
    }
  });
  return squared;
}

} // namespace

std::vector<float> computeDistances(const Marks& marks, const Grid& grid, double most) {
  const Size3& size = grid.size;
  std::vector<float> squared = computeRowDistances(marks, grid, static_cast<float>(most));
  std::vector<float> next(squared.size());
  for (const int axis : {1, 2}) {
    const auto range = static_cast<std::int64_t>(most / grid.spacing()[axis]);
    const auto edge = static_cast<float>(grid.spacing()[axis]);
    const std::int64_t stride = axis == 1 ? size.x() : size.x() * size.y();
    forEachRow(size, [&](std::int64_t y, std::int64_t z, std::size_t row) {
      const std::int64_t at = axis == 1 ? y : z;
      float* const to = &next[row];
      std::copy_n(&squared[row], size.x(), to);
      const std::int64_t end = std::min(range, size[axis] - 1 - at);
      for (std::int64_t step = std::max(-range, -at); step <= end; ++step) {
        const float* const from = &squared[row] + step * stride;
        const float across = edge * edge * static_cast<float>(step * step);
        std::transform(to, to + size.x(), from, to,
                       [across](float a, float b) { return std::min(a, b + across); });
      }
    });
    squared.swap(next);
  }
  forEachRow(size, [&](std::int64_t, std::int64_t, std::size_t row) {
    for (std::size_t i = row; i < row + static_cast<std::size_t>(size.x()); ++i)
      squared[i] = std::sqrt(squared[i]);
  });
  return squared;
}

} // namespace fenestra::core
