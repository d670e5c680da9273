#pragma once
// Signals that ask the process to end: INT, TERM, HUP (terminal closed), QUIT, XCPU, and PIPE
// (standard output closed). The first ends the process at once; where that would cost finished
// work (DeferredStop), the second. Signals ignored when the process began (nohup) stay ignored.

#include <atomic>

namespace fenestra {

inline constexpr int stoppedStatus = 5;

/// Installs the handlers. Call before files are read or made.
void installStopHandlers();

/// True once any of those signals has come.
bool isStopRequested();

/// Exit status of a command that was asked to stop: stoppedStatus, or the status of an output error
/// if standard output is closed.
int stopStatus();

/// Ends the process, whatever other threads are doing, as soon as no result is being put in place.
/// Removes temporary files.
[[noreturn]] void endProcess(int status);

/// Makes the first signal set `stop` instead of ending the process, for the object's lifetime. At
/// most one instance at a time.
class DeferredStop {
public:
  explicit DeferredStop(std::atomic<bool>& stop);
  ~DeferredStop();
  DeferredStop(const DeferredStop&) = delete;
  DeferredStop& operator=(const DeferredStop&) = delete;
};

} // namespace fenestra
