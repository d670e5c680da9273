#pragma once
// This program, run once more in a process of its own: a crash of one piece of work ends no other.

#include "io/Descriptor.h"

#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

namespace fenestra {

/// Child process with default signal handlers, no files of this process, no standard input,
/// standard output discarded and standard error kept. Signals of the terminal do not reach the
/// child; the kernel kills the child when the thread that made it ends.
class ChildProcess {
public:
  /// Runs `fenestra arguments…`. Throws Error (output) where no process can be started.
  explicit ChildProcess(std::vector<std::string> arguments);
  /// Kills the process if it still runs.
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// True once the process has ended. Does not wait.
  bool hasEnded();
  /// Exit status; 128 and the signal's number for a process that a signal ended. 0 until then.
  int status() const { return m_status; }
  void send(int signal) const;
  /// Last 64 kB written to standard error so far.
  std::string errors() const;

private:
  pid_t m_id = 0; ///< 0: ended
  int m_status = 0;
  Descriptor m_errors; ///< file in memory
};

} // namespace fenestra
