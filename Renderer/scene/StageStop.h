#pragma once
// Stopping of long stages.

#include "base/Error.h"
#include "base/StopFlag.h"

namespace fenestra::core {

/// Stop flag of a stage, which is no part of its key.
struct StageStop {
  const StopFlag* flag = &neverStopped;

  bool operator==(const StageStop& /*other*/) const { return true; }
};

/// Throws Error (request, ErrorCode::stopped) if the flag is set.
inline void requireRunning(const StopFlag& stop) {
  if (stop)
    throw requestError(ErrorCode::stopped, "render", "was stopped before the first pass");
}

} // namespace fenestra::core
