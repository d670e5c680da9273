#pragma once
// Reading in a process of its own, for libraries that do not survive damaged files: GDCM and HDF5.
//
// The child runs the parent's own executable (/proc/self/exe: the same build, even if the file has
// been replaced since) and inherits no memory, files, threads or locks. A program whose readers
// work apart calls serveApart first in main, as fenestra, its tests and its fuzz targets do. In any
// other program Apart::ask throws std::logic_error instead of running that program's main again.

#include "base/safe/Descriptor.h"

#include <cstdint>
#include <optional>
#include <string>

namespace fenestra {

/// Limits of a child, which is killed beyond `seconds`; beyond `bytes` its allocations fail.
struct ApartLimits {
  unsigned seconds = 5; ///< processor time for a question, s; 3 times as long by the clock
  std::uint64_t bytes = std::uint64_t{2} << 30; ///< address space, libraries included
};

/// Work for a child: bytes in, bytes out. Declared as a constant at namespace scope, next to the
/// caller of Apart::ask.
class ApartJob {
public:
  /// Answers a question in the child. Empty string or exception: no answer, since the file is not
  /// of the expected format.
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

/// One child process, started by the first question and restarted after a failure. The child has no
/// standard streams and no files of the parent; it may open 32 files, write none and leave no core;
/// its signal handlers are the defaults, and signals of the terminal do not reach it. The kernel
/// kills the child when the thread that started it ends: call `ask` from one thread, which outlives
/// the object.
class Apart {
public:
  explicit Apart(const ApartJob& job) : m_job(job) {}
  ~Apart() { end(); }
  Apart(const Apart&) = delete;
  Apart& operator=(const Apart&) = delete;

  /// Returns the child's answer, unchecked, at most `most` bytes; empty: the job gave no answer.
  /// nullopt: `question` exceeds 64 kB, or the child crashed, exceeded its limits or answered with
  /// more than `most` bytes. Throws Error (output) where no process can be started.
  std::optional<std::string> ask(const std::string& question, std::uint64_t most);

private:
  void start();
  void end();

  const ApartJob& m_job;
  int m_child = 0;         ///< process id; 0: not running
  Descriptor m_connection; ///< socket to the child
};

/// In a child: answers questions until the parent closes the connection or dies, and does not
/// return. In any other process: enables Apart::ask and returns.
void serveApart(int argc, char** argv);

} // namespace fenestra
