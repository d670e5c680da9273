#pragma once
// Quality of a clip: how well the remaining context meets the focus along the focus's outline.
// Measured alike for every kind of clip.

#include "base/Distribution.h"
#include "clip/field/Clip.h"
#include "clip/focus/FocusDepth.h"
#include "model/volume/Domain.h"

namespace fenestra {

/// Focus depth against context depth along the outline, whose points are found by bisection between
/// a focus sample and a neighbour outside the focus. Context depth: where the context begins just
/// beyond the outline, at the clip's surface or where the eye ray enters the volume. For clips with
/// steps (cutaway, hole): extrapolated linearly from the two samples beyond.
struct BoundaryMetrics {
  Distribution gap; ///< |context depth - focus depth|, mm, without depth jumps
  /// Difference of the slopes of two samples on each side, mm of depth per mm, without depth jumps.
  Distribution slopeJump;
  double depthJumpFraction = 0.0; ///< share of the crossings where the focus's own depth jumps
  std::size_t crossings = 0;
};

/// Threshold, mm: the focus jumps at a sample if a neighbour's depth differs by more.
constexpr double depthJump = 2.0;

/// Measures `clip` along the outline of `focus`, whose `depths` are seen from the clip's camera.
/// All measures are 0 for ClipNone.
BoundaryMetrics measureBoundary(const Clip& clip, const Domain& volume, const Mask& focus,
                                const FocusDepth& depths);

} // namespace fenestra
