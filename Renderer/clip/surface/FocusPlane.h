#pragma once
// Cutting plane placed automatically.

#include "clip/focus/FocusDepth.h"
#include "clip/keep/Clip.h"

namespace fenestra {

/// Least-squares plane, in depth, through the visible points of the focus, never seen edge-on. The
/// normal points towards the eye. Needs at least one focus sample; with too few samples to
/// determine a tilt the plane faces the eye.
ClipPlane focusPlane(const Camera& camera, const FocusDepth& focus);

} // namespace fenestra
