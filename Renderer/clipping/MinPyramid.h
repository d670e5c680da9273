#pragma once
// The least depth over any rectangle of a depth buffer, from a few look-ups.

#include "clipping/DepthBuffer.h"

#include <vector>

namespace fenestra {

/// Level 0 holds the least depth of 2 x 2 samples, each further level that of 2 x 2 below it.
class MinPyramid {
public:
  explicit MinPyramid(const DepthBuffer& buffer);

  /// A lower bound, in mm, of what the buffer returns, interpolated or not, anywhere in the
  /// rectangle between two positions in mm: the least sample of it and its near surroundings.
  double lowerBound(const DepthBuffer& buffer, const Vec2& a, const Vec2& b) const;

private:
  struct Level {
    std::int64_t columns, rows;
    std::vector<double> least;
  };
  std::vector<Level> m_levels;
};

} // namespace fenestra
