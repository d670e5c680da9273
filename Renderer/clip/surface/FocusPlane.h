#pragma once
// A cutting plane that nobody has to place.

#include "clip/focus/FocusDepth.h"
#include "clip/keep/Clip.h"

namespace fenestra {

/// The plane that comes nearest to what the eye sees of the focus: of all that are not seen edge-on
/// the one with the least squared distance from it in depth. Its normal points towards the eye.
/// At least one sample has to be focus; too few to tilt it, and it faces the eye.
ClipPlane focusPlane(const Camera& camera, const FocusDepth& focus);

} // namespace fenestra
