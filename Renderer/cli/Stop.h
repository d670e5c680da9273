#pragma once
// Ctrl-C and SIGTERM. Before a render runs they end the process at once; then they stop the render,
// which keeps its finished passes; what is being written becomes whole. Exit status 5 either way.

#include "render/Render.h"

namespace fenestra {

inline constexpr int stoppedStatus = 5;

/// One at a time, for as long as signals are to be handled.
class StopOnSignal {
public:
  StopOnSignal();
  ~StopOnSignal();
  StopOnSignal(const StopOnSignal&) = delete;
  StopOnSignal& operator=(const StopOnSignal&) = delete;

  /// From now on signals set monitor.stop instead of ending the process. The monitor outlives this.
  void stopRender(RenderMonitor& monitor);
};

} // namespace fenestra
