#pragma once
// Reading in a process of its own, for libraries that do not survive damaged files: GDCM and HDF5.
//
// The child runs the parent's own executable (/proc/self/exe: the same build, even if the file has
// been replaced since; under a loader that was called with it, the file of its name) and inherits
// no memory, files, threads or locks. A program whose readers work apart calls serveSandbox first
// in main, as fenestra, its tests and its fuzz targets do. In any other program Apart::ask throws
// std::logic_error instead of running that program's main again.

#include "base/Text.h"
#include "io/Descriptor.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fenestra {

/// Limits of a child, which is killed beyond `seconds`; beyond `bytes` its allocations fail.
struct SandboxLimits {
  unsigned seconds = 5; ///< processor time for a question, s; 3 times as long by the clock
  std::uint64_t bytes = std::uint64_t{2} << 30; ///< address space, libraries included
};

/// Work for a child: bytes in, bytes out. Declared as a constant at namespace scope, next to the
/// caller of Apart::ask.
struct SandboxJob {
  /// Answers a question in the child. Empty string or exception: no answer, since the file is not
  /// of the expected format.
  using Handler = std::string (*)(const std::string& question);

  SandboxJob(std::string name, Handler handler, SandboxLimits limits = {});

  const std::string name;
  const Handler handler;
  const SandboxLimits limits;
};

/// One child process, started by the first question and restarted after a failure. The child has no
/// standard streams and no files of the parent; it may open 32 files, write none and leave no core;
/// its signal handlers are the defaults, and signals of the terminal do not reach it. The kernel
/// kills the child when the thread that started it ends: call `ask` from one thread, which outlives
/// the object.
class SandboxedReader {
public:
  explicit SandboxedReader(const SandboxJob& job) : m_job(job) {}
  ~SandboxedReader() { end(); }
  SandboxedReader(const SandboxedReader&) = delete;
  SandboxedReader& operator=(const SandboxedReader&) = delete;

  /// Returns the child's answer, unchecked, at most `most` bytes; empty: the job gave no answer.
  /// nullopt: `question` exceeds 64 kB, or the child crashed, exceeded its limits or answered with
  /// more than `most` bytes. Throws Error (output) where no process can be started.
  std::optional<std::string> request(const std::string& message, std::uint64_t maxBytes);

private:
  void start();
  void end();

  const SandboxJob& m_job;
  int m_child = 0;         ///< process id; 0: not running
  Descriptor m_connection; ///< socket to the child
};

/// Encodes texts and lists of numbers in an answer, in the child: a size (8 bytes), then as many
/// bytes of characters or doubles.
class ReplyWriter {
public:
  void put(std::string_view text) {
    const std::uint64_t size = text.size();
    m_bytes.append(reinterpret_cast<const char*>(&size), sizeof size).append(text);
  }
  void put(const std::vector<double>& numbers) { put(asBytes(numbers)); }
  const std::string& bytes() const { return m_bytes; }

private:
  std::string m_bytes;
};

/// Decodes an answer, in the parent. Throws std::runtime_error for a truncated answer, or a number
/// that is not finite.
class ReplyReader {
public:
  explicit ReplyReader(std::string_view bytes) : m_bytes(bytes) {}

  bool isAtEnd() const { return m_bytes.empty(); }
  std::string text();
  /// Finite numbers, in the order written.
  std::vector<double> numbers();

private:
  std::string_view m_bytes;
};

/// In a child: answers questions until the parent closes the connection or dies, and does not
/// return. In any other process: enables Apart::ask and returns.
void serveSandbox(int argc, char** argv);

} // namespace fenestra
