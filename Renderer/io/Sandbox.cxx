#include "io/Sandbox.h"

#include "base/Error.h"
#include "io/ReaderProgram.h"
#include "io/SelfExec.h"
#include "io/SystemErrors.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstring>
#include <ctime>
#include <fcntl.h>
#include <fstream>
#include <linux/landlock.h>
#include <mutex>
#include <poll.h>
#include <spawn.h>
#include <stdexcept>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>
#include <utility>

namespace fenestra::core {
namespace {

using Clock = std::chrono::steady_clock;

constexpr const char* subcommand = "read-apart"; // first argument of a child; internal
constexpr int childConnection = 3;
constexpr std::uint64_t maxRequestBytes = 1 << 16; // bytes; fits into a socket's buffer

// ---- frames: the length in 8 bytes, then the content

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

/// Limits this process irrevocably: `bytes` of address space (except under sanitizers, which map
/// terabytes), 32 open files, no growing file, no core dump, no right to change files. The kernel
/// kills this process when its parent dies. False if process number `parent` is gone already, or a
/// limit cannot be set.
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

/// Makes the kernel kill this process after `seconds` more of CPU time.
void limitCpuTime(unsigned seconds) {
  const auto used = static_cast<rlim_t>(std::clock() / CLOCKS_PER_SEC);
  rlimit both{};
  ::getrlimit(RLIMIT_CPU, &both);
  both.rlim_cur = std::min(both.rlim_max, used + seconds);
  ::setrlimit(RLIMIT_CPU, &both);
}

// ---- the child

bool servesSandbox = false; ///< main has called serveSandbox
bool isChild = false;       ///< this process is a child
thread_local bool readsInProcess = false;

/// All jobs of this program.
std::vector<const SandboxJob*>& registeredJobs() {
  static std::vector<const SandboxJob*> jobs;
  return jobs;
}

[[noreturn]] void serveRequests(const SandboxJob& job) {
  isChild = true;
  const SandboxJob::Handler handler = job.handler;
  while (const auto request = receiveFrame(childConnection, maxRequestBytes, std::nullopt)) {
    limitCpuTime(job.limits.seconds);
    std::string reply;
    try {
      reply = handler(*request);
    } catch (...) { // the parent reports the error
      reply.clear();
    }
    if (!sendFrame(childConnection, reply))
      break;
  }
  ::_exit(0);
}

// ---- starting a child

/// What a child executes.
struct ChildProgram {
  std::filesystem::path file;
  ArgumentList arguments;

  static ChildProgram choose(const std::string& job) {
    std::vector<std::string> arguments = {subcommand, job, std::to_string(::getpid())};
    if (servesSandbox)
      return {selfExecutable, ArgumentList(makeSelfArguments(std::move(arguments)))};
    arguments.insert(arguments.begin(), readerName);
    return {findReaderProgram(), ArgumentList(std::move(arguments))};
  }
};

/// Starts the child, with its end of the connection as its only file, and default signal handlers.
/// Returns an error code, 0: success.
int spawn(const ChildProgram& program, int connection, pid_t& child) {
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
  const int failed = ::posix_spawn(&child, program.file.c_str(), &files, &attributes,
                                   program.arguments.get(), environ);
  ::posix_spawnattr_destroy(&attributes);
  ::posix_spawn_file_actions_destroy(&files);
  return failed;
}

/// Throws Error (output) for an error code of spawn or of the system calls before it.
void checkStart(int failed, const std::filesystem::path& program) {
  if (failed == EACCES || failed == ENOEXEC)
    throw outputError(ErrorCode::unreadableFile, program,
                      "cannot be executed: ", systemMessage(failed), "; install it again");
  if (failed != 0)
    throw outputError(ErrorCode::outOfMemory, "memory",
                      "cannot start a process to read files; close other programs");
}

/// Receives the child's build. Throws Error (output) unless it is this one.
void checkBuild(int connection, const std::filesystem::path& program) {
  constexpr std::chrono::seconds maxTime(60); // to load its libraries from a slow disk
  constexpr std::uint64_t maxBytes = 256;
  const auto build = receiveFrame(connection, maxBytes, Clock::now() + maxTime);
  if (!build)
    throw outputError(ErrorCode::outOfMemory, program,
                      "ended before it could read a file; close other programs, or install it "
                      "again");
  if (*build != readerBuild)
    throw outputError(ErrorCode::invalidFile, program,
                      "is of another build than this library; install both together");
}

} // namespace

SandboxJob::SandboxJob(std::string nameIn, Handler handlerIn, SandboxLimits limitsIn)
    : name(std::move(nameIn)), handler(handlerIn), limits(limitsIn) {
  registeredJobs().push_back(this);
}

void SandboxedReader::start() {
  const ChildProgram program = ChildProgram::choose(m_job.name);
  std::array<int, 2> ends{};
  int failed = 0;
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) == 0) {
    m_connection = Descriptor(ends[0]);
    failed = spawn(program, *Descriptor(ends[1]), m_child);
  } else {
    failed = errno;
  }
  m_thread = ::gettid();
  try {
    checkStart(failed, program.file);
    checkBuild(*m_connection, program.file);
  } catch (...) {
    end();
    throw;
  }
}

void SandboxedReader::end() {
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

std::optional<std::string> SandboxedReader::request(const std::string& message,
                                                    std::uint64_t maxBytes) {
  if (message.size() > maxRequestBytes)
    return std::nullopt;
  if (readsInProcess)
    return handleHere(message, maxBytes);
  if (m_thread != ::gettid())
    end();
  if (m_child == 0)
    start();
  constexpr unsigned wallClockFactor = 3;
  const auto deadline = Clock::now() + std::chrono::seconds(wallClockFactor * m_job.limits.seconds);
  std::optional<std::string> reply;
  if (sendFrame(*m_connection, message))
    reply = receiveFrame(*m_connection, maxBytes, deadline);
  if (!reply)
    end();
  return reply;
}

std::optional<std::string> SandboxedReader::handleHere(const std::string& message,
                                                       std::uint64_t maxBytes) {
  static std::mutex mutex; // the libraries have global state, and HDF5 no locks
  const std::lock_guard lock(mutex);
  if (!m_handler)
    m_handler = m_job.handler;
  try {
    std::string reply = m_handler(message);
    return reply.size() > maxBytes ? std::nullopt : std::optional(std::move(reply));
  } catch (...) { // the caller reports the error
    return "";
  }
}

InProcessReading::InProcessReading() : m_previous(std::exchange(readsInProcess, true)) {}

InProcessReading::~InProcessReading() {
  readsInProcess = m_previous;
}

std::string ReplyReader::text() {
  const auto take = [this](std::uint64_t size) {
    if (size > m_bytes.size())
      throw std::runtime_error("reply is truncated");
    std::string taken(m_bytes.substr(0, static_cast<std::size_t>(size)));
    m_bytes.remove_prefix(taken.size());
    return taken;
  };
  std::uint64_t size = 0;
  std::memcpy(&size, take(sizeof size).data(), sizeof size);
  return take(size);
}

std::vector<double> ReplyReader::numbers() {
  const std::string bytes = text();
  std::vector<double> numbers(bytes.size() / sizeof(double));
  if (bytes.size() != numbers.size() * sizeof(double))
    throw std::runtime_error("reply ends within a number");
  std::ranges::copy(bytes, reinterpret_cast<char*>(numbers.data()));
  if (!std::ranges::all_of(numbers, [](double x) { return std::isfinite(x); }))
    throw std::runtime_error("reply contains a number that is not finite");
  return numbers;
}

void limitMemory(std::uint64_t bytes) {
  std::uint64_t pages = 0; // of address space
  std::ifstream("/proc/self/statm") >> pages;
  rlimit both{};
  if (!isChild || hasSanitizer || pages == 0 || ::getrlimit(RLIMIT_AS, &both) != 0)
    return;
  const auto used = static_cast<rlim_t>(pages) * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE));
  both.rlim_cur = std::min<rlim_t>(both.rlim_max, used + bytes);
  ::setrlimit(RLIMIT_AS, &both);
}

void serveSandbox(int argc, char** argv) {
  servesSandbox = true;
  if (argc != 4 || std::string_view(argv[1]) != subcommand)
    return;
  const auto job =
      std::ranges::find(registeredJobs(), std::string_view(argv[2]), &SandboxJob::name);
  if (job == registeredJobs().end())
    sendFrame(childConnection, ""); // of another build: the parent has this job
  else if (confineProcess((*job)->limits.bytes, argv[3]) && sendFrame(childConnection, readerBuild))
    serveRequests(**job);
  ::_exit(1);
}

} // namespace fenestra::core
