#include "io/Apart.h"

#include "core/Error.h"

#include <cerrno>
#include <csignal>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace fenestra {
namespace {

constexpr unsigned longestSeconds = 300;

/// Memory that a child process shares.
class SharedBytes {
public:
  explicit SharedBytes(std::size_t size)
      : m_size(size),
        m_bytes(::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0)) {
    if (m_bytes == MAP_FAILED)
      throw outputError("memory", "there is none left to decode into; close other programs");
  }
  ~SharedBytes() { ::munmap(m_bytes, m_size); }
  SharedBytes(const SharedBytes&) = delete;
  SharedBytes& operator=(const SharedBytes&) = delete;

  char* data() const { return static_cast<char*>(m_bytes); }

private:
  std::size_t m_size;
  void* m_bytes;
};

/// The child's whole life.
[[noreturn]] void live(char* place, const std::function<bool(char*)>& fill) {
  for (const int signal : {SIGINT, SIGTERM})
    ::signal(signal, SIG_DFL);
  const rlimit noCore{0, 0};
  ::setrlimit(RLIMIT_CORE, &noCore);
  ::alarm(longestSeconds);
  const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  ::dup2(nowhere, STDOUT_FILENO);
  ::dup2(nowhere, STDERR_FILENO);
  bool done = false;
  try {
    done = fill(place);
  } catch (...) { // the parent says what there is to say
  }
  ::_exit(done ? 0 : 1);
}

} // namespace

std::optional<std::string> filledApart(std::size_t size, const std::function<bool(char*)>& fill) {
  const SharedBytes bytes(size);
  const pid_t child = ::fork();
  if (child < 0)
    throw outputError("process", "no other can be started; close other programs");
  if (child == 0)
    live(bytes.data(), fill);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR)
    ;
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
    return std::nullopt;
  return std::string(bytes.data(), size);
}

} // namespace fenestra
