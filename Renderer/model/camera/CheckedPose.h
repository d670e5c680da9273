#pragma once
// A camera's pose that is composed: a scene's under its transforms, or one of flags and defaults.

#include "base/Checked.h"
#include "model/camera/Camera.h"

namespace fenestra {

/// The pose, where a camera can take it: places within 1e12 mm, apart from each other, and up not
/// along the view. Throws otherwise.
CameraPose checkedPose(const CameraPose& pose, const Complaint& complaint);

} // namespace fenestra
