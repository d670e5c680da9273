#pragma once
// Checks of smoothed labels, for mutations that no render of the matrix shows.

#include "model/masks/EqualVolume.h"
#include "model/masks/MaskShaping.h"
#include "model/medium/LabelWeights.h"

#include <algorithm>

namespace fenestra::core::testing {

/// Mask of the voxels of a grid that satisfy isInside(voxel).
template <typename Predicate>
Mask makeLabels(const Grid& grid, const Predicate& isInside) {
  Mask mask;
  mask.grid = grid;
  for (std::int64_t z = 0; z < grid.size.z(); ++z)
    for (std::int64_t y = 0; y < grid.size.y(); ++y)
      for (std::int64_t x = 0; x < grid.size.x(); ++x)
        mask.voxels.push_back(isInside(Vec3(Size3(x, y, z).cast<double>())));
  return mask;
}

/// True if smoothing preserves the volume of a ball, and the label weights of two smoothed segments
/// change gradually from one to the other.
inline bool areLabelsValid() {
  const Grid grid(Size3::Constant(24), Affine::Identity());
  const Mask ball =
      makeLabels(grid, [](const Vec3& p) { return (p - Vec3(11.3, 11.6, 11.8)).norm() < 8.0; });
  const Mask smooth = smoothMaskAuto(ball, 1.0, grid);
  if (std::abs(measureVolumeChange(ball, smooth, grid)) > 0.003)
    return false;
  const Mask rest =
      smoothMaskAuto(makeLabels(grid, [](const Vec3& p) { return p.x() > 11.0; }), 1.0, grid);
  const LabelWeights weights(2, [&](std::size_t i) -> LabelWeights::Part {
    return {i == 0 ? smooth : rest, static_cast<int>(i), static_cast<std::uint8_t>(i + 1)};
  });
  double last = 0.0, greatestStep = 0.0;
  for (double x = 0.0; x < 12.0; x += 0.5) {
    double inBall = 0.0;
    weights.forEachWeight(
        weights.grid().worldToIndex * Vec3(x, 11.6, 11.8),
        [&](std::uint8_t component, double weight) { inBall += component == 1 ? weight : 0.0; });
    greatestStep = std::max(greatestStep, std::abs(inBall - last));
    last = inBall;
  }
  return greatestStep < 0.25 && last > 0.4;
}

} // namespace fenestra::core::testing
