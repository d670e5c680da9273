#pragma once
// Signals that ask the process to end: INT, TERM, HUP (terminal closed), QUIT, XCPU, and PIPE
// (standard output closed). The first ends the process at once; where that would cost finished
// work (StopInstead), the second. Signals ignored when the process began (nohup) stay ignored.

#include <atomic>

namespace fenestra {

inline constexpr int stoppedStatus = 5;

/// Installs the handlers. Call before files are read or made.
void handleStops();

/// True once any of those signals has come.
bool stopRequested();

/// Exit status of a command that was asked to stop: stoppedStatus, or the status of an output error
/// if standard output is closed.
int stopStatus();

/// Ends the process, whatever other threads are doing, as soon as no result is being put in place.
/// Removes temporary files.
[[noreturn]] void endProcess(int status);

/// Makes the first signal set `stop` instead of ending the process, for the object's lifetime. At
/// most one instance at a time.
class StopInstead {
public:
  explicit StopInstead(std::atomic<bool>& stop);
  ~StopInstead();
  StopInstead(const StopInstead&) = delete;
  StopInstead& operator=(const StopInstead&) = delete;
};

} // namespace fenestra
