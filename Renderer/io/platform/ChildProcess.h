#pragma once
// Runs this program again as a child process, so that a crash there does not end this process.

#include "io/platform/Descriptor.h"

#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

namespace fenestra::core {

/// Child process with default signal handlers, at most one file of this process, no standard input,
/// standard output discarded and standard error recorded. Signals of the terminal do not reach it.
/// The kernel kills it when the thread that created it ends.
class ChildProcess {
public:
  /// Descriptor by which the child has the file that it inherits.
  static constexpr int inheritedFile = 3;

  /// Runs `fenestra arguments…`. The child ends with `failureStatus` if it cannot execute the
  /// program. `inherited`: a file that it inherits, or null. Throws Error (output) if no process
  /// can be started.
  ChildProcess(std::vector<std::string> arguments, int failureStatus,
               const Descriptor* inherited = nullptr);
  /// Kills the process if it still runs.
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// True once the process has ended. Does not wait.
  bool hasEnded();
  /// Exit status, or 128 plus the number of the signal that ended the process. 0 until then.
  int status() const { return m_status; }
  void send(int signal) const;
  /// Last 64 kB written to standard error so far.
  std::string errors() const;

private:
  pid_t m_id = 0; ///< 0: ended
  int m_status = 0;
  Descriptor m_errors; ///< file in memory
};

} // namespace fenestra::core
