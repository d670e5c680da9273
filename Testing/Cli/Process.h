#pragma once
// Runs the executable under test in a child process, with captured output.

#include <filesystem>
#include <functional>
#include <string>
#include <thread>
#include <vector>

namespace fenestra::core {

using Arguments = std::vector<std::string>;

struct Outcome {
  int status = -1; ///< exit status; -1 if a signal ended the process
  std::string out;
  std::string err;      ///< standard error without the result line
  std::string result;   ///< line that states what a command that succeeded has written; empty: none
  std::string messages; ///< all of standard error
  double cpuSeconds = 0.0; ///< processor time of the process during wait(), of all threads
};

/// Target of a process's standard output: a file that the test reads, a pipe without a reader, or a
/// device on which every write fails for lack of space.
enum class Stdout { file, closedPipe, fullDisk };

/// Target of standard error: a file or a terminal of 80 columns, of which the test reads the
/// output.
enum class Stderr { file, terminal };

/// Process `fenestra arguments…` in `folder`. The constructor starts it, the destructor kills it.
class Process {
public:
  Process(const Arguments& arguments, const std::filesystem::path& folder,
          Stdout out = Stdout::file, Stderr err = Stderr::file);
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  void send(int signal) const;
  /// Writes to standard input.
  void write(const std::string& text) const;
  void closeInput();
  /// Waits until a condition holds. Returns whether it holds; false: the process has ended, or
  /// `hangLimit` has passed.
  bool waitUntil(const std::function<bool()>& condition) const;
  /// Waits until the process has a handler for `signal`.
  bool waitUntilHandling(int signal) const;
  /// Waits until the process has opened `file`.
  bool waitUntilOpen(const std::filesystem::path& file) const;
  /// Waits until standard output matches a regular expression.
  bool waitForOutput(const std::string& expression) const;
  /// Same, of standard error.
  bool waitForMessage(const std::string& expression) const;
  std::string output() const;   ///< standard output so far
  std::string messages() const; ///< standard error so far
  /// Processor time of the process so far in seconds, of all threads; 0 if it has ended.
  double cpuSeconds() const;
  /// Waits until the process ends; kills it after `hangLimit`.
  Outcome wait();

  /// Seconds after which a process is taken to hang, even on a busy machine.
  static constexpr double hangLimit = 300.0;

private:
  bool isRunning() const;
  void reap(int flags) const; ///< stores how the process ended, if it has; `flags` of wait4()

  int m_id = 0;
  int m_in = -1;              ///< pipe to standard input
  int m_out = -1, m_err = -1; ///< memory files for standard output and standard error
  std::jthread m_terminal;    ///< copies what the terminal shows to m_err
  mutable int m_waitStatus = 0;
  mutable double m_cpuSeconds = 0.0; ///< of the ended process and its children
  mutable bool m_ended = false;
};

/// Runs a process until it ends.
Outcome run(const Arguments& arguments, const std::filesystem::path& folder);

} // namespace fenestra::core
