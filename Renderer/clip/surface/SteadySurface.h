#pragma once
// A clipping surface for frames of a turn, in which nothing may jump.
//
// When the focus's outline changes its course (one part comes out from behind another, or control
// points fall elsewhere), the surface around it changes at once. Here it is, away from the focus,
// the mean of the surfaces of cameras that stand a little before and after on the same turn, at the
// same (x, y): what one camera's surface does suddenly, this one does over the angle between them.
// Near the focus it stays its own, so that focus and context meet as they did: from the focus's
// edge on, the mean comes in smoothly, over as far as the turn may move the focus in the picture.

#include "clip/surface/ClippingSurface.h"

namespace fenestra {

/// The surface of five cameras, from `degrees` before to `degrees` after (model/camera/Turn.h),
/// with binomial weights. With 0 degrees, and in the other modes, what buildClippingSurface builds.
ClippingSurface buildSteadySurface(const Camera& camera, const Domain& volume, const Mask& focus,
                                   const SurfaceOptions& options, double degrees);

} // namespace fenestra
