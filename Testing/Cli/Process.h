#pragma once
// Runs the executable under test as a shell would.

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace fenestra {

using Arguments = std::vector<std::string>;

struct Outcome {
  int status = -1; ///< exit status; -1 where the process had to be killed, or a signal ended it
  std::string out, err;
  double seconds = 0.0; ///< waited for
};

/// Who reads a process's standard output; a full disk takes nothing of it.
enum class Reader { test, nobody, fullDisk };

/// `fenestra arguments…`, running in `folder` from construction on; killed by the destructor.
class Process {
public:
  Process(const Arguments& arguments, const std::filesystem::path& folder,
          Reader reader = Reader::test);
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  void send(int signal) const;
  /// To its standard input.
  void write(const std::string& text) const;
  void closeInput();
  /// Until the process handles `signal` itself; false after ten seconds or at its end.
  bool waitUntilHandling(int signal) const;
  /// Until its standard output has what matches a regular expression; false after as long as wait()
  /// waits, or at its end.
  bool waitForOutput(const std::string& expression) const;
  std::string output() const; ///< so far
  /// Until its end, and kills it after 30 seconds; slow builds have more (FENESTRA_BRIEF).
  Outcome wait();

private:
  bool running() const;
  bool waitUntil(const std::function<bool()>& condition, double limit) const;

  int m_id = 0;
  int m_in = -1;              ///< of a pipe
  int m_out = -1, m_err = -1; ///< files in memory
  mutable int m_waitStatus = 0;
  mutable bool m_ended = false;
};

/// Runs to its end.
Outcome run(const Arguments& arguments, const std::filesystem::path& folder);

} // namespace fenestra
