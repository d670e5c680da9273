#pragma once
// Signals that request the end of the process: INT, TERM, HUP (terminal closed), QUIT, XCPU, and
// PIPE (standard output closed). The first signal ends the process at once; with DeferredStop, the
// second does, so that finished work is saved. Signals ignored at the start (nohup) stay ignored.

#include <atomic>

namespace fenestra::core {

inline constexpr int stoppedStatus = 5;

/// Installs the signal handlers. Call before files are read or written.
void installStopHandlers();

/// True after any of these signals.
bool isStopRequested();

/// Exit status after a signal: stoppedStatus; if standard output was closed, that of an output
/// error, or 0 after allowClosedOutput().
int stopStatus();

/// Ends the process from any thread, but never while results are being renamed into place. Removes
/// temporary files.
[[noreturn]] void endProcess(int status);

/// During its lifetime, the first signal sets `stop` instead of ending the process. At most one
/// instance at a time.
class DeferredStop {
public:
  explicit DeferredStop(std::atomic<bool>& stop);
  ~DeferredStop();
  DeferredStop(const DeferredStop&) = delete;
  DeferredStop& operator=(const DeferredStop&) = delete;
};

} // namespace fenestra::core
