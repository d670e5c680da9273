#pragma once
// Metric of a turntable's temporal stability: change of the clipping surface while the camera
// rotates around the focus.

#include "clip/field/Clip.h"
#include "clip/focus/FocusDepth.h"

#include <vector>

namespace fenestra::core {

/// Clipping surface at an image's pixels, row by row from the top.
struct VisibleSurface {
  Camera camera;
  std::vector<Region> regions;
  std::vector<double> depths; ///< of the surface, mm; of the focus in Region::focus
};

/// `focusDepth`: depth of the focus at each pixel, mm; infinity if missed.
VisibleSurface makeVisibleSurface(const ClipDepth& clip, const std::vector<double>& focusDepth,
                                  const Domain& volume);

/// Changes per degree of rotation, mm.
struct SurfaceChange {
  /// Change of the surface's depth over all pixels that are context in both images.
  double mean = 0.0, p95 = 0.0, max = 0.0;
  /// Motion of the visible focus point that is farthest from the axis.
  double focus = 0.0;

  /// Largest change of the surface in excess of the motion of the focus.
  double excess() const { return std::max(0.0, max - focus); }
};

/// Change between two cameras with the same target, `degrees` apart around `axis` through it.
SurfaceChange measureChange(const VisibleSurface& before, const VisibleSurface& after,
                            const Vec3& axis, double degrees);

} // namespace fenestra::core
