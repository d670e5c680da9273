#pragma once
// Temporal smoothing of the clipping surface, for the frames of a turntable.
//
// The surface of a single camera jumps when the outline of the focus changes abruptly: a part
// appears from behind another, or control points move. Away from the focus, a steady surface is
// therefore the mean at the same (x, y) of the surfaces of cameras a little before and after, which
// spreads a jump over their angle. Near the focus, the camera's own surface remains, so that focus
// and context meet as before. The weight of the mean rises smoothly with the distance from the
// focus, up to the distance by which the rotation can move the focus in the image. A frame depends
// on its own request only, so frames can be rendered in any order.

#include "clip/surface/ClippingSurface.h"

namespace fenestra::core {

/// Mean surface of five cameras, from `degrees` before to `degrees` after (rotateAroundTarget),
/// with binomial weights. For 0 degrees, and modes other than `surface`: buildClippingSurface.
ClippingSurface buildSteadySurface(const Camera& camera, const Domain& volume, const Mask& focus,
                                   const SurfaceOptions& options, double degrees);

} // namespace fenestra::core
