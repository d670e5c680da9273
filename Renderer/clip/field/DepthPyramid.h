#pragma once
// Least and greatest depth over any rectangle of a depth buffer, from a few look-ups.

#include "clip/field/SilhouetteCells.h"
#include "clip/focus/DepthBuffer.h"

#include <vector>

namespace fenestra {

/// Level 0 holds the extremes of 2 x 2 samples, each further level those of 2 x 2
/// entries of the level below.
class DepthPyramid {
public:
  explicit DepthPyramid(const DepthBuffer& buffer, const SilhouetteCells* silhouette = nullptr);

  /// Bounds of the surface depth (nearest, linear, or in seams) over the rectangle between two
  /// positions, mm. Samples near the rectangle count as well, so bounds may be wider.
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

} // namespace fenestra
