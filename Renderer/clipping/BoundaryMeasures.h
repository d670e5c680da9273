#pragma once
// How well what is left of the context meets the focus, along the focus's outline: the same for
// every kind of clip.

#include "clipping/Clip.h"
#include "clipping/FocusDepth.h"
#include "volume/Domain.h"

#include <vector>

namespace fenestra {

struct Distribution {
  double mean = 0.0, p95 = 0.0, max = 0.0;

  static Distribution of(std::vector<double> values); ///< zeros of none
};

/// Where an outline passes between two samples, the focus has a depth and a slope on its side, and
/// on the other the context begins at some depth: where the clip leaves it, or where the eye ray
/// enters the volume. Each side is continued linearly, the context to the focus's last sample.
struct BoundaryMeasures {
  Distribution gap;        ///< mm between the two depths there, without depth jumps
  Distribution slopeJump;  ///< between the two slopes, mm of depth per mm, without depth jumps
  double depthJumps = 0.0; ///< share of the outline where the focus's own depth jumps
  std::size_t crossings = 0;
};

/// mm by which a sample's depth differs from a neighbour's where the focus is said to jump.
constexpr double depthJump = 2.0;

BoundaryMeasures measureBoundary(const Clip& clip, const Domain& volume, const FocusDepth& focus);

} // namespace fenestra
