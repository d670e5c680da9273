#pragma once
// Reading in a process of its own, for libraries that do not survive damaged files: GDCM and HDF5.
//
// The child is this very program (/proc/self/exe, so of the same build even where the file has been
// replaced since), started anew: it has nothing of the parent's memory, files, threads and locks.
// So a program whose readers work apart calls serveApart first of all in main, as fenestra, its
// tests and its fuzz targets do; in any other, asking throws std::logic_error instead of running
// that program's main again.

#include <cstdint>
#include <optional>
#include <string>

namespace fenestra {

/// What a child may take for one question before it is ended.
struct ApartLimits {
  unsigned seconds = 5;                         ///< of a processor; by the clock, thrice as many
  std::uint64_t bytes = std::uint64_t{2} << 30; ///< of address space, its libraries' included
};

/// Work for a child: bytes in, bytes out. A constant at namespace scope, beside who asks.
class ApartJob {
public:
  /// An empty answer, as an exception, says that there is none: the file is not what it should be.
  using Answer = std::string (*)(const std::string& question);

  ApartJob(std::string name, Answer answer, ApartLimits limits = {});

  const std::string& name() const { return m_name; }
  std::string answer(const std::string& question) const { return m_answer(question); }
  const ApartLimits& limits() const { return m_limits; }

private:
  std::string m_name;
  Answer m_answer;
  ApartLimits m_limits;
};

/// One child, started when first asked, and again after it was ended. It has no standard streams
/// and no other files of the parent's; it may open 32 files, write none and leave no core; its
/// signals are the defaults, and the terminal's do not reach it. It ends with the thread that
/// started it: ask from one thread, which outlives the object.
class Apart {
public:
  explicit Apart(const ApartJob& job) : m_job(job) {}
  ~Apart() { end(); }
  Apart(const Apart&) = delete;
  Apart& operator=(const Apart&) = delete;

  /// The child's answer, of at most `most` bytes, which nobody has checked; empty where there is
  /// none. Nothing where the child crashed, took more than its limits, or answered at more length.
  /// `question` has at most 64 kB. Throws Error (output) where no process can be started.
  std::optional<std::string> ask(const std::string& question, std::uint64_t most);

private:
  void start();
  void end();

  const ApartJob& m_job;
  int m_child = 0;       ///< its process, or 0
  int m_connection = -1; ///< a socket
};

/// In a child, answers until its parent is done or gone, and does not return.
void serveApart(int argc, char** argv);

} // namespace fenestra
