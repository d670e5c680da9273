#pragma once
// Sandboxed child process: its start, its end, and the connection to its parent, on which each
// message is a frame: its length in 8 bytes, then its content. For io/Sandbox.

#include "io/platform/Descriptor.h"

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

namespace fenestra::core {

// ---- in the parent

/// A child and its connection. For one thread at a time.
class SandboxProcess {
public:
  SandboxProcess() = default;
  ~SandboxProcess() { end(); }
  SandboxProcess(const SandboxProcess&) = delete;
  SandboxProcess& operator=(const SandboxProcess&) = delete;

  /// Starts `program arguments… PID`, PID being that of this process. The connection is the child's
  /// only file; it has default signal handlers. Returns the error code of the system, 0: success.
  int start(const std::filesystem::path& program, std::vector<std::string> arguments);
  /// True if this thread has started the child. The kernel kills it when that thread ends.
  bool isOwn() const;
  /// Kills the child if it is one of this process.
  void end();

  /// False: the child has ended.
  bool send(const std::string& message);
  /// nullopt: no message of at most `maxBytes` bytes within `time`.
  std::optional<std::string> receive(std::uint64_t maxBytes, std::chrono::seconds time);

private:
  pid_t m_child = 0;       ///< process id; 0: not running
  pid_t m_thread = 0;      ///< that started it; of no other process
  Descriptor m_connection; ///< socket to the child
};

// ---- in the child

bool sendToParent(const std::string& message);
/// Waits for a message of at most `maxBytes` bytes; nullopt: none follows.
std::optional<std::string> receiveFromParent(std::uint64_t maxBytes);

/// Limits this process irrevocably: `bytes` of address space (except under sanitizers, which map
/// terabytes), 32 open files, no growing file, no core dump, no right to change files. The kernel
/// kills this process when its parent dies. False if process number `parent` is gone already, or a
/// limit cannot be set.
bool confineProcess(std::uint64_t bytes, const char* parent);

/// Makes the kernel kill this process after `seconds` more of CPU time.
void limitCpuTime(unsigned seconds);

/// Lets this process allocate at most `bytes` more, until the next call and within confineProcess's
/// limit. No effect under sanitizers.
void limitAddressSpace(std::uint64_t bytes);

} // namespace fenestra::core
