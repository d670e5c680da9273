#pragma once
// The clipping surface of one camera, for display while the camera moves: the depth of the focus at
// the pitch of the view, and around it the same fill as in stills (SmoothFill.h), on a coarser
// grid. Only the outline, from which the fill starts, is found at the pitch of the view: the whole
// context depends on it.

#include "clip/portable/SurfaceDepth.h"

namespace fenestra::core {

/// A camera as VTK describes it.
struct LiveCamera {
  std::array<double, 3> position, target, up; ///< mm; `up` need not be perpendicular
  bool isPerspective;
  double angle;      ///< vertical, degrees; of perspective cameras
  double scale;      ///< half of the height that is seen, mm; of orthographic cameras
  int width, height; ///< of the view, pixels
};

struct DepthMap {
  SampleGrid grid;
  std::vector<float> depths; ///< mm, row by row
};

struct LiveSurface {
  ViewFrame view;
  /// The view's part of the focus, at the pixels' centers; infinity: not focus.
  DepthMap focus;
  /// The surface beside the focus, over more than the view; empty if no sample shows the focus. In
  /// the focus its depths, but at the outline those of the surface beside it.
  DepthMap fill;
};

/// Corners of the volume's box, mm: bit i of the index chooses the side of axis i.
using BoxCorners = std::array<std::array<double, 3>, 8>;

/// Throws std::invalid_argument for a camera without direction or size.
LiveSurface buildLiveSurface(const ClosedSurface& focus, const BoxCorners& volume,
                             const LiveCamera& camera);

} // namespace fenestra::core
