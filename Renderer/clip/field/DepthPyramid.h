#pragma once
// Min-max pyramid of a depth buffer: depth bounds over any rectangle from a few look-ups.

#include "clip/field/SilhouetteCells.h"
#include "clip/focus/DepthBuffer.h"

#include <vector>

namespace fenestra::core {

/// Level 0 holds the minimum and maximum of 2 x 2 samples, each coarser level those of 2 x 2
/// entries of the finer level.
class DepthPyramid {
public:
  explicit DepthPyramid(const DepthBuffer& buffer, const SilhouetteCells* silhouette = nullptr);

  /// Bounds of the surface depth, mm, over the rectangle between two positions, for both kinds of
  /// look-up and in silhouette cells. Conservative: samples near the rectangle are included.
  Interval bounds(const DepthBuffer& buffer, const Vec2& a, const Vec2& b) const;

private:
  struct Level {
    std::int64_t columns, rows;
    std::vector<SilhouetteCells::DepthBounds> extremes;
  };

  template <typename Below>
  static Level buildCoarser(std::int64_t columns, std::int64_t rows, const Below& below);

  std::vector<Level> m_levels;
};

} // namespace fenestra::core
