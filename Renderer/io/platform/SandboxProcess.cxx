#include "io/platform/SandboxProcess.h"

#include "io/platform/SelfExec.h"

#include <algorithm>
#include <array>
#include <csignal>
#include <ctime>
#include <fstream>
#include <string_view>

#include <fcntl.h>
#include <linux/landlock.h>
#include <poll.h>
#include <spawn.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

namespace fenestra::core {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int childConnection = 3;

// ---- frames

bool sendAll(int connection, std::string_view bytes) {
  while (!bytes.empty()) {
    const auto sent =
        retryOnEintr([&] { return ::send(connection, bytes.data(), bytes.size(), MSG_NOSIGNAL); });
    if (sent < 0)
      return false;
    bytes.remove_prefix(static_cast<std::size_t>(sent));
  }
  return true;
}

bool sendFrame(int connection, const std::string& bytes) {
  const std::uint64_t length = bytes.size();
  return sendAll(connection, {reinterpret_cast<const char*>(&length), sizeof length}) &&
         sendAll(connection, bytes);
}

/// Waits for readable bytes. False: none before `deadline`; nullopt: no deadline.
bool waitReadable(int connection, std::optional<Clock::time_point> deadline) {
  using std::chrono::milliseconds;
  pollfd event{connection, POLLIN, 0};
  for (;;) {
    int left = -1;
    if (deadline)
      left = static_cast<int>(std::max<std::int64_t>(
          0, std::chrono::ceil<milliseconds>(*deadline - Clock::now()).count()));
    const int ready = ::poll(&event, 1, left);
    if (ready >= 0 || errno != EINTR)
      return ready > 0;
  }
}

bool receiveAll(int connection, char* to, std::uint64_t size,
                std::optional<Clock::time_point> deadline) {
  while (size > 0) {
    if (!waitReadable(connection, deadline))
      return false;
    const auto count =
        retryOnEintr([&] { return ::recv(connection, to, static_cast<std::size_t>(size), 0); });
    if (count <= 0)
      return false;
    to += count;
    size -= static_cast<std::uint64_t>(count);
  }
  return true;
}

std::optional<std::string> receiveFrame(int connection, std::uint64_t maxBytes,
                                        std::optional<Clock::time_point> deadline) {
  std::uint64_t length = 0;
  if (!receiveAll(connection, reinterpret_cast<char*>(&length), sizeof length, deadline) ||
      length > maxBytes)
    return std::nullopt;
  std::string bytes(static_cast<std::size_t>(length), '\0');
  if (!receiveAll(connection, bytes.data(), length, deadline))
    return std::nullopt;
  return bytes;
}

// ---- starting a child

/// Starts the child, with its end of the connection as its only file, and default signal handlers.
/// Returns an error code, 0: success.
int spawn(const std::filesystem::path& program, const ArgumentList& arguments, int connection,
          pid_t& child) {
  posix_spawn_file_actions_t files;
  ::posix_spawn_file_actions_init(&files);
  ::posix_spawn_file_actions_adddup2(&files, connection, childConnection);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    ::posix_spawn_file_actions_addopen(&files, stream, "/dev/null", O_RDWR, 0);
  ::posix_spawn_file_actions_addclosefrom_np(&files, childConnection + 1);

  posix_spawnattr_t attributes;
  ::posix_spawnattr_init(&attributes);
  sigset_t signals;
  ::sigemptyset(&signals);
  ::posix_spawnattr_setsigmask(&attributes, &signals);
  ::sigfillset(&signals);
  ::posix_spawnattr_setsigdefault(&attributes, &signals);
  ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF |
                                              POSIX_SPAWN_SETPGROUP);
  const int failed =
      ::posix_spawn(&child, program.c_str(), &files, &attributes, arguments.get(), environ);
  ::posix_spawnattr_destroy(&attributes);
  ::posix_spawn_file_actions_destroy(&files);
  return failed;
}

// ---- confinement of the child

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool hasSanitizer = true;
#elif defined(__has_feature)
constexpr bool hasSanitizer = __has_feature(address_sanitizer) || __has_feature(thread_sanitizer);
#else
constexpr bool hasSanitizer = false;
#endif

/// Lowers a limit irrevocably.
bool lowerLimit(__rlimit_resource resource, rlim_t maximum) {
  rlimit both{};
  if (::getrlimit(resource, &both) != 0)
    return false;
  both.rlim_max = std::min(both.rlim_max, maximum);
  both.rlim_cur = both.rlim_max;
  return ::setrlimit(resource, &both) == 0;
}

/// Drops all rights to write, create, remove and execute files, irrevocably. No effect on kernels
/// without Landlock.
void forbidFileChanges() {
  landlock_ruleset_attr rights{};
  rights.handled_access_fs =
      LANDLOCK_ACCESS_FS_WRITE_FILE | LANDLOCK_ACCESS_FS_EXECUTE | LANDLOCK_ACCESS_FS_REMOVE_DIR |
      LANDLOCK_ACCESS_FS_REMOVE_FILE | LANDLOCK_ACCESS_FS_MAKE_CHAR | LANDLOCK_ACCESS_FS_MAKE_DIR |
      LANDLOCK_ACCESS_FS_MAKE_REG | LANDLOCK_ACCESS_FS_MAKE_SOCK | LANDLOCK_ACCESS_FS_MAKE_FIFO |
      LANDLOCK_ACCESS_FS_MAKE_BLOCK | LANDLOCK_ACCESS_FS_MAKE_SYM;
  const long rules = ::syscall(SYS_landlock_create_ruleset, &rights, sizeof rights, 0);
  if (rules < 0)
    return;
  ::syscall(SYS_landlock_restrict_self, rules, 0);
  ::close(static_cast<int>(rules));
}

} // namespace

int SandboxProcess::start(const std::filesystem::path& program,
                          std::vector<std::string> arguments) {
  arguments.push_back(std::to_string(::getpid()));
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
    return errno;
  m_connection = Descriptor(ends[0]);
  m_thread = ::gettid();
  return spawn(program, ArgumentList(std::move(arguments)), *Descriptor(ends[1]), m_child);
}

bool SandboxProcess::isOwn() const {
  return m_child != 0 && m_thread == ::gettid();
}

void SandboxProcess::end() {
  siginfo_t state{};
  // Not if the process id is not a child's: this process was forked from the parent, or the program
  // has waited for the child.
  if (m_child != 0 && retryOnEintr([&] {
                        return ::waitid(P_PID, static_cast<id_t>(m_child), &state,
                                        WEXITED | WNOHANG | WNOWAIT);
                      }) == 0) {
    ::kill(m_child, SIGKILL);
    retryOnEintr([this] { return ::waitpid(m_child, nullptr, 0); });
  }
  m_child = 0;
  m_connection = Descriptor();
}

bool SandboxProcess::send(const std::string& message) {
  return sendFrame(*m_connection, message);
}

std::optional<std::string> SandboxProcess::receive(std::uint64_t maxBytes,
                                                   std::chrono::seconds time) {
  return receiveFrame(*m_connection, maxBytes, Clock::now() + time);
}

bool sendToParent(const std::string& message) {
  return sendFrame(childConnection, message);
}

std::optional<std::string> receiveFromParent(std::uint64_t maxBytes) {
  return receiveFrame(childConnection, maxBytes, std::nullopt);
}

bool confineProcess(std::uint64_t bytes, const char* parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (std::to_string(::getppid()) != parent)
    return false; // the parent died before PR_SET_PDEATHSIG
  ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
  forbidFileChanges();
  constexpr rlim_t maxFiles = 32;
  return lowerLimit(RLIMIT_CORE, 0) && lowerLimit(RLIMIT_FSIZE, 0) &&
         lowerLimit(RLIMIT_NOFILE, maxFiles) && (hasSanitizer || lowerLimit(RLIMIT_AS, bytes));
}

void limitCpuTime(unsigned seconds) {
  const auto used = static_cast<rlim_t>(std::clock() / CLOCKS_PER_SEC);
  rlimit both{};
  ::getrlimit(RLIMIT_CPU, &both);
  both.rlim_cur = std::min(both.rlim_max, used + seconds);
  ::setrlimit(RLIMIT_CPU, &both);
}

void limitAddressSpace(std::uint64_t bytes) {
  std::uint64_t pages = 0; // of address space
  std::ifstream("/proc/self/statm") >> pages;
  rlimit both{};
  if (hasSanitizer || pages == 0 || ::getrlimit(RLIMIT_AS, &both) != 0)
    return;
  const auto used = static_cast<rlim_t>(pages) * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE));
  both.rlim_cur = std::min<rlim_t>(both.rlim_max, used + bytes);
  ::setrlimit(RLIMIT_AS, &both);
}

} // namespace fenestra::core
