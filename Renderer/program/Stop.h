#pragma once
// Signals that ask the process to end: INT, TERM, HUP (the terminal was closed), QUIT, XCPU, and
// PIPE (nobody reads standard output any more). At first they end it at once; where that would cost
// finished work they set a flag instead, and the second signal ends it at once. What was ignored
// when the process began (nohup) stays ignored.

#include <atomic>

namespace fenestra {

inline constexpr int stoppedStatus = 5;

/// From now on those signals are handled: before anything is read or made.
void handleStops();

/// Whether any of those signals has come.
bool stopRequested();

/// Exit status of a command that was asked to stop: stoppedStatus, or that of an output error where
/// nobody reads standard output.
int stopStatus();

/// Ends the process, whatever other threads are about, as soon as no result is being put in place.
/// Leaves no temporary file.
[[noreturn]] void endProcess(int status);

/// While it lives, the first signal sets `stop` instead of ending the process. One at a time.
class StopInstead {
public:
  explicit StopInstead(std::atomic<bool>& stop);
  ~StopInstead();
  StopInstead(const StopInstead&) = delete;
  StopInstead& operator=(const StopInstead&) = delete;
};

} // namespace fenestra
