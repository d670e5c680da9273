#pragma once
// Clip metric: how well the remaining context meets the focus along the outline of the focus.
// Defined equally for all clip modes.

#include "base/Distribution.h"
#include "clip/field/Clip.h"
#include "clip/focus/FocusDepth.h"
#include "model/volume/Domain.h"

namespace fenestra::core {

/// Compares focus depth and context depth along the outline, which is located by bisection between
/// a focus sample and a neighbor outside. The context depth is where the context begins just
/// outside the outline: at the clip's surface, or where the camera ray enters the volume. For clips
/// with steps (cutaway, hole), it is extrapolated linearly from the two samples outside.
struct BoundaryMetrics {
  Distribution gap; ///< |context depth - focus depth|, mm, without depth jumps
  /// Difference of the two-sample slopes on both sides, mm of depth per mm, without depth jumps.
  Distribution slopeJump;
  /// Fraction of the crossings where the focus depth itself jumps, or continues in a closed slot.
  double depthJumpFraction = 0.0;
  std::size_t crossings = 0;
};

/// mm; the focus depth jumps at a sample if a neighbor's depth differs by more.
constexpr double depthJump = 2.0;

/// Measures `clip` along the outline of `focus`. `depths`: of the focus, from the clip's camera.
/// All metrics are 0 for ClipNone.
BoundaryMetrics measureBoundary(const Clip& clip, const Domain& volume, const Mask& focus,
                                const FocusDepth& depths);

} // namespace fenestra::core
