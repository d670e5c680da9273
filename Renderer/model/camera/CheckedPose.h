#pragma once
// Composed camera poses: a scene's camera under transforms, or flags with defaults.

#include "base/Checked.h"
#include "model/camera/Camera.h"

namespace fenestra {

/// Returns `pose` if valid: position and target differ and lie within 1e12 mm, and up is neither
/// zero nor along the view. Throws otherwise.
CameraPose checkedPose(const CameraPose& pose, const Complaint& complaint);

} // namespace fenestra
