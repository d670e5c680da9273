#pragma once
// How well what is left of the context meets the focus, along the focus's outline: the same for
// every kind of clip.

#include "base/Distribution.h"
#include "clip/focus/FocusDepth.h"
#include "clip/keep/Clip.h"
#include "model/volume/Domain.h"

namespace fenestra {

/// On the focus's outline, which is found by bisection between a sample of the focus and a
/// neighbour that is none, the focus has a depth, and just beyond it the context begins at one:
/// where the clip leaves it, or where the eye ray enters the volume. Where the clip has steps
/// (cutaway, hole) that is of samples beyond, continued linearly.
struct BoundaryMeasures {
  Distribution gap; ///< mm between the two depths there, without depth jumps
  /// Between the slopes of two samples on each side, mm of depth per mm, without depth jumps.
  Distribution slopeJump;
  double depthJumps = 0.0; ///< share of the outline where the focus's own depth jumps
  std::size_t crossings = 0;
};

/// mm by which a focus sample's depth differs from a neighbour's where the focus is said to jump.
constexpr double depthJump = 2.0;

/// `depths` are those of `focus`, for the clip's camera.
BoundaryMeasures measureBoundary(const Clip& clip, const Domain& volume, const Mask& focus,
                                 const FocusDepth& depths);

} // namespace fenestra
