#pragma once
// The least and the greatest depth over any rectangle of a depth buffer, from a few look-ups.

#include "clip/focus/DepthBuffer.h"
#include "clip/keep/Seams.h"

#include <vector>

namespace fenestra {

/// Level 0 holds the extremes of 2 x 2 samples, each further level those of 2 x 2 below it.
class DepthPyramid {
public:
  explicit DepthPyramid(const DepthBuffer& buffer, const Seams* seams = nullptr);

  struct Bounds {
    double least, greatest; ///< mm
  };

  /// Bounds of what the buffer returns, interpolated or not, or its seams, anywhere in the
  /// rectangle between two positions in mm: the extreme samples of it and its near surroundings.
  Bounds bounds(const DepthBuffer& buffer, const Vec2& a, const Vec2& b) const;

private:
  /// As the buffer keeps them: less the depth of the camera's target.
  struct Extremes {
    float least, greatest;
  };
  struct Level {
    std::int64_t columns, rows;
    std::vector<Extremes> extremes;
  };

  template <typename Below>
  static Level halved(std::int64_t columns, std::int64_t rows, const Below& below);

  std::vector<Level> m_levels;
};

} // namespace fenestra
