#pragma once
// How a clipping surface changes while the eye goes around its focus: what a turntable is judged
// by.

#include "clip/focus/FocusDepth.h"
#include "clip/keep/Clip.h"

#include <vector>

namespace fenestra {

/// A clipping surface as the pixels of a picture see it, row by row from the top.
struct SeenSurface {
  Camera camera;
  std::vector<Region> regions;
  std::vector<double> depths; ///< of the surface: the focus's own where it is seen; mm
};

/// `focusDepth`: of the focus at each pixel, infinity where it is missed.
SeenSurface seenSurface(const ClipDepth& clip, const std::vector<double>& focusDepth,
                        const Domain& volume);

/// What happens while the eye turns by a degree; mm.
struct SurfaceChange {
  /// By how much the surface's depth differs, over all pixels that are context before and after.
  double mean = 0.0, p95 = 0.0, max = 0.0;
  /// How far the farthest point from the axis, of the focus that is seen, moves.
  double focus = 0.0;

  /// By how much the surface's greatest change is beyond what the focus itself does.
  double excess() const { return std::max(0.0, max - focus); }
};

/// Of two cameras with one target, `degrees` apart around the axis that leads through it.
SurfaceChange changeBetween(const SeenSurface& before, const SeenSurface& after, const Vec3& axis,
                            double degrees);

} // namespace fenestra
