#pragma once
// Ctrl-C and SIGTERM. At first they end the process at once; where that would cost finished work or
// leave a file half-written, they set a flag instead. Exit status 5 either way.

#include <atomic>

namespace fenestra {

inline constexpr int stoppedStatus = 5;

/// Ends the process with that status, whatever other threads are about; nothing may be
/// half-written.
[[noreturn]] void endStopped();

/// One at a time, for as long as signals are to be handled.
class StopOnSignal {
public:
  StopOnSignal();
  ~StopOnSignal();
  StopOnSignal(const StopOnSignal&) = delete;
  StopOnSignal& operator=(const StopOnSignal&) = delete;

  /// From now on signals set `stop` instead of ending the process. It outlives this.
  void setInstead(std::atomic<bool>& stop);
};

} // namespace fenestra
