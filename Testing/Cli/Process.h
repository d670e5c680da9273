#pragma once
// Runs the executable under test in a child process, with captured output.

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace fenestra {

using Arguments = std::vector<std::string>;

struct Outcome {
  int status = -1; ///< exit status; -1 if a signal ended the process
  std::string out, err;
  std::string
      statusLine;       ///< status line about appearance, lights and labels, moved here from `err`
  double seconds = 0.0; ///< wall-clock time of wait()
};

/// Target of a process's standard output: a file that the test reads, a pipe without a reader, or a
/// device on which every write fails for lack of space.
enum class Stdout { file, closedPipe, fullDisk };

/// Process `fenestra arguments…` in `folder`. The constructor starts it, the destructor kills it.
class Process {
public:
  Process(const Arguments& arguments, const std::filesystem::path& folder,
          Stdout target = Stdout::file);
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  void send(int signal) const;
  /// Writes to standard input.
  void write(const std::string& text) const;
  void closeInput();
  /// Waits until the process has a handler for `signal`. False if it ends, or after ten seconds.
  bool waitUntilHandling(int signal) const;
  /// Waits until standard output matches a regular expression. False if the process ends, or after
  /// the time limit of wait().
  bool waitForOutput(const std::string& expression) const;
  std::string output() const; ///< standard output so far
  /// Waits until the process ends; kills it after 30 seconds, times FENESTRA_BRIEF in slow builds.
  Outcome wait();

private:
  bool isRunning() const;
  bool waitUntil(const std::function<bool()>& condition, double limit) const;

  int m_id = 0;
  int m_in = -1;              ///< pipe to standard input
  int m_out = -1, m_err = -1; ///< memory files for standard output and standard error
  mutable int m_waitStatus = 0;
  mutable bool m_ended = false;
};

/// Runs a process until it ends.
Outcome run(const Arguments& arguments, const std::filesystem::path& folder);

} // namespace fenestra
