#pragma once
// Reads files in a sandboxed child process, for libraries that crash on damaged files: GDCM, HDF5,
// libpng and libtiff. NRRD and NIfTI are read in this process, which avoids copying volumes through
// a socket.
//
// The child runs the parent's executable (/proc/self/exe: the same build even if the file has been
// replaced; the program's file if a loader was started with it). It inherits no memory, files,
// threads or locks. A program that uses SandboxedReader must call serveSandbox first in main, as
// fenestra, its tests and its fuzz targets do. In other programs SandboxedReader::request throws
// std::logic_error instead of running main again.
//
// Replies are as untrusted as the file, and interpreted in the parent. A file for which the child
// crashes or exceeds its limits is rejected. One child reads all files of a folder.

#include "base/Text.h"
#include "io/Descriptor.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fenestra::core {

/// Limits of a child. Beyond `seconds` it is killed; beyond `bytes` its allocations fail.
struct SandboxLimits {
  unsigned seconds = 5; ///< CPU time per request, s; three times as much wall-clock time
  std::uint64_t bytes = std::uint64_t{2} << 30; ///< address space, libraries included
};

/// Function that runs in a child: bytes in, bytes out. Declared as a constant at namespace scope,
/// beside the caller of SandboxedReader::request.
struct SandboxJob {
  /// Handles a request in the child. An empty string or an exception means that there is no reply,
  /// since the file does not have the expected format.
  using Handler = std::string (*)(const std::string& request);

  SandboxJob(std::string name, Handler handler, SandboxLimits limits = {});

  const std::string name;
  const Handler handler;
  const SandboxLimits limits;
};

/// One child process, started by the first request and restarted after a failure. It has no
/// standard streams and no files of the parent. It may open 32 files, write none and dump no core.
/// Its signal handlers are the defaults, and signals of the terminal do not reach it. The kernel
/// kills it when the thread that started it ends: call `request` from one thread, which outlives
/// the object.
class SandboxedReader {
public:
  explicit SandboxedReader(const SandboxJob& job) : m_job(job) {}
  ~SandboxedReader() { end(); }
  SandboxedReader(const SandboxedReader&) = delete;
  SandboxedReader& operator=(const SandboxedReader&) = delete;

  /// Returns the child's reply of at most `maxBytes` bytes, not validated; empty: the handler gave
  /// no reply. nullopt: `message` exceeds 64 kB, or the child crashed, exceeded its limits or
  /// replied with more than `maxBytes` bytes. Throws Error (output) if no process can be started.
  std::optional<std::string> request(const std::string& message, std::uint64_t maxBytes);

private:
  void start();
  void end();

  const SandboxJob& m_job;
  int m_child = 0;         ///< process id; 0: not running
  Descriptor m_connection; ///< socket to the child
};

/// Encodes texts and lists of numbers in a reply, in the child: a size (8 bytes), then that many
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

/// Decodes a reply, in the parent. Throws std::runtime_error for a truncated reply or a number that
/// is not finite.
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

/// In a child's handler: lets the process allocate at most `bytes` more, within its job's limit,
/// until the next call; then allocations fail. No effect under sanitizers.
void limitMemory(std::uint64_t bytes);

/// In a child: handles requests until the parent closes the connection or dies, and does not
/// return. In any other process: enables SandboxedReader::request and returns.
void serveSandbox(int argc, char** argv);

} // namespace fenestra::core
