#pragma once
// Runs the executable under test as a shell would.

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace fenestra {

using Arguments = std::vector<std::string>;

struct Outcome {
  int status = -1; ///< exit status; -1 if a signal ended the process
  std::string out, err;
  std::string statusLine; ///< line that tells look, light and labels, taken out of `err`
  double seconds = 0.0;   ///< wall time until the end
};

/// Reader of a process's standard output; a full disk accepts nothing.
enum class Reader { test, closedPipe, fullDisk };

/// `fenestra arguments…`, started in `folder` by the constructor, killed by the destructor.
class Process {
public:
  Process(const Arguments& arguments, const std::filesystem::path& folder,
          Reader reader = Reader::test);
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  void send(int signal) const;
  /// Writes to standard input.
  void write(const std::string& text) const;
  void closeInput();
  /// Waits until the process handles `signal` itself; false after ten seconds or at the process's
  /// end.
  bool waitUntilHandling(int signal) const;
  /// Waits until standard output matches a regular expression; false after the time limit of
  /// wait(), or at the process's end.
  bool waitForOutput(const std::string& expression) const;
  std::string output() const; ///< so far
  /// Waits until the process ends; kills it after 30 seconds, in slow builds later
  /// (FENESTRA_BRIEF).
  Outcome wait();

private:
  bool isRunning() const;
  bool waitUntil(const std::function<bool()>& condition, double limit) const;

  int m_id = 0;
  int m_in = -1;              ///< pipe to standard input
  int m_out = -1, m_err = -1; ///< files in memory
  mutable int m_waitStatus = 0;
  mutable bool m_ended = false;
};

/// Runs a process to its end.
Outcome run(const Arguments& arguments, const std::filesystem::path& folder);

} // namespace fenestra
