#pragma once
// Clipping surface for frames of a turn, without jumps from frame to frame.
//
// When the focus's outline changes its course (one part comes out from behind another, or control
// points fall elsewhere), the surface of one camera jumps. A steady surface is, away from the
// focus, the mean at the same (x, y) of the surfaces of cameras a little before and after on the
// same turn: the jump is spread over the angle between these cameras. Near the focus the camera's
// own surface stays, so that focus and context meet as before; the share of the mean rises smoothly
// with the distance from the focus, over as far as the turn may move the focus in the picture.

#include "clip/surface/ClippingSurface.h"

namespace fenestra {

/// Surface of five cameras, from `degrees` before to `degrees` after (rotateAroundTarget), with
/// binomial weights. For 0 degrees, and in modes other than `surface`: the result of
/// buildClippingSurface.
ClippingSurface buildSteadySurface(const Camera& camera, const Domain& volume, const Mask& focus,
                                   const SurfaceOptions& options, double degrees);

} // namespace fenestra
