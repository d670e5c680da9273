#pragma once
// Change of a clipping surface while the eye goes around its focus: the measure of a turntable's
// steadiness.

#include "clip/field/Clip.h"
#include "clip/focus/FocusDepth.h"

#include <vector>

namespace fenestra {

/// Clipping surface at a picture's pixels, row by row from the top.
struct VisibleSurface {
  Camera camera;
  std::vector<Region> regions;
  std::vector<double> depths; ///< of the surface, mm; in the region focus: of the focus
};

/// `focusDepth`: depth of the focus at each pixel, mm; infinity: missed.
VisibleSurface makeVisibleSurface(const ClipDepth& clip, const std::vector<double>& focusDepth,
                                  const Domain& volume);

/// Changes per degree of turn, mm.
struct SurfaceChange {
  /// Change of the surface's depth over all pixels that are context before and after.
  double mean = 0.0, p95 = 0.0, max = 0.0;
  /// Motion of the visible focus's point farthest from the axis.
  double focus = 0.0;

  /// Part of the surface's greatest change beyond the motion of the focus.
  double excess() const { return std::max(0.0, max - focus); }
};

/// Change between two cameras with one target, `degrees` apart around `axis` through the target.
SurfaceChange measureChange(const VisibleSurface& before, const VisibleSurface& after,
                            const Vec3& axis, double degrees);

} // namespace fenestra
