#pragma once
// Reads files in a sandboxed child process, for libraries that crash on damaged files: GDCM, HDF5,
// libpng and libtiff. NRRD and NIfTI are read in this process, which avoids copying volumes through
// a socket.
//
// The child runs the parent's executable if its main calls serveSandbox first, as fenestra, its
// tests and its fuzz targets do (/proc/self/exe: the same build even if the file has been replaced;
// the program's file if a loader was started with it). In other programs, which use Fenestra as a
// library, the child runs fenestra-reader (io/ReaderProgram.h). It tells its build first: replies
// have no format that other builds know. It inherits no memory, files, threads or locks.
//
// Programs that use Fenestra as a library may ignore SIGCHLD or wait for any child, fork, and use
// threads. They get SIGCHLD for the children.
//
// Replies are as untrusted as the file, and interpreted in the parent. A file for which the child
// crashes or exceeds its limits is rejected. One child reads all files of a folder.

#include "base/Text.h"
#include "io/platform/SandboxProcess.h"

#include <cstdint>
#include <functional>
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
  /// since the file does not have the expected format. Each SandboxedReader has a copy, which may
  /// keep something from one request to the next.
  using Handler = std::function<std::string(const std::string& request)>;

  SandboxJob(std::string name, Handler handler, SandboxLimits limits = {});

  const std::string name;
  const Handler handler;
  const SandboxLimits limits;
};

/// One child process, started by the first request and restarted after a failure. It has no
/// standard streams and no files of the parent. It may open 32 files, write none and dump no core.
/// Its signal handlers are the defaults, and signals of the terminal do not reach it. The kernel
/// kills it when the thread that started it ends; another thread, or a forked process, starts its
/// own. Not for concurrent use.
class SandboxedReader {
public:
  explicit SandboxedReader(const SandboxJob& job) : m_job(job) {}

  /// Returns the child's reply of at most `maxBytes` bytes, not validated; empty: the handler gave
  /// no reply. nullopt: `message` exceeds 64 kB, or the child crashed, exceeded its limits or
  /// replied with more than `maxBytes` bytes. Throws Error (output) if no process can be started
  /// (outOfMemory), or fenestra-reader is missing (missingFile) or of another build (invalidFile).
  std::optional<std::string> request(const std::string& message, std::uint64_t maxBytes);

private:
  void start();
  std::optional<std::string> handleHere(const std::string& message, std::uint64_t maxBytes);

  const SandboxJob& m_job;
  SandboxProcess m_child;
  SandboxJob::Handler m_handler; ///< in this process; empty: not used yet
};

/// During its lifetime, SandboxedReader::request handles the requests of this thread in this
/// process, one at a time: for callers that trust the files, or may not start processes. The limits
/// of SandboxLimits do not apply, and a file for which a library crashes ends this process.
class InProcessReading {
public:
  InProcessReading();
  ~InProcessReading();
  InProcessReading(const InProcessReading&) = delete;
  InProcessReading& operator=(const InProcessReading&) = delete;

private:
  bool m_previous;
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
/// until the next call; then allocations fail. No effect under sanitizers, and in other processes.
void limitMemory(std::uint64_t bytes);

/// In a child: handles requests until the parent closes the connection or dies, and does not
/// return. In any other process: lets children run this program, and returns.
void serveSandbox(int argc, char** argv);

} // namespace fenestra::core
