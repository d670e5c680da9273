#include "base/safe/Apart.h"

#include "base/Error.h"
#include "base/safe/Confinement.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <stdexcept>
#include <string_view>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>
#include <utility>
#include <vector>

namespace fenestra {
namespace {

using Clock = std::chrono::steady_clock;

constexpr const char* subcommand = "read-apart"; // not for users
constexpr int childConnection = 3;
constexpr std::uint64_t longestQuestion = 1 << 16; // bytes; less than a socket holds

// ---- frames: a length of 8 bytes, then as many bytes

bool sendAll(int connection, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t sent = ::send(connection, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent < 0 && errno != EINTR)
      return false;
    bytes.remove_prefix(static_cast<std::size_t>(std::max<ssize_t>(sent, 0)));
  }
  return true;
}

bool sendFrame(int connection, const std::string& bytes) {
  const std::uint64_t length = bytes.size();
  return sendAll(connection, {reinterpret_cast<const char*>(&length), sizeof length}) &&
         sendAll(connection, bytes);
}

/// Waits for bytes to receive. False: none before `deadline`; nullopt: no deadline.
bool waits(int connection, std::optional<Clock::time_point> deadline) {
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

bool receiveAll(int connection, char* place, std::uint64_t size,
                std::optional<Clock::time_point> deadline) {
  while (size > 0) {
    if (!waits(connection, deadline))
      return false;
    const ssize_t received = ::recv(connection, place, static_cast<std::size_t>(size), 0);
    if (received == 0 || (received < 0 && errno != EINTR))
      return false;
    const auto count = std::max<ssize_t>(received, 0);
    place += count;
    size -= static_cast<std::uint64_t>(count);
  }
  return true;
}

std::optional<std::string> receiveFrame(int connection, std::uint64_t most,
                                        std::optional<Clock::time_point> deadline) {
  std::uint64_t length = 0;
  if (!receiveAll(connection, reinterpret_cast<char*>(&length), sizeof length, deadline) ||
      length > most)
    return std::nullopt;
  std::string bytes(static_cast<std::size_t>(length), '\0');
  if (!receiveAll(connection, bytes.data(), length, deadline))
    return std::nullopt;
  return bytes;
}

// ---- the child

struct Jobs {
  std::vector<const ApartJob*> all;
  bool served = false; ///< this program's main calls serveApart
};

/// Jobs of this program.
Jobs& jobs() {
  static Jobs known;
  return known;
}

[[noreturn]] void answerAll(const ApartJob& job) {
  while (const auto question = receiveFrame(childConnection, longestQuestion, std::nullopt)) {
    allowSeconds(job.limits().seconds);
    std::string answer;
    try {
      answer = job.answer(*question);
    } catch (...) { // the parent reports the error
      answer.clear();
    }
    if (!sendFrame(childConnection, answer))
      break;
  }
  ::_exit(0);
}

// ---- starting a child

/// Attributes of a new child: no file but its end of the connection, default signal handlers.
class Beginning {
public:
  explicit Beginning(int connection) {
    ::posix_spawn_file_actions_init(&m_files);
    ::posix_spawn_file_actions_adddup2(&m_files, connection, childConnection);
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
      ::posix_spawn_file_actions_addopen(&m_files, stream, "/dev/null", O_RDWR, 0);
    ::posix_spawn_file_actions_addclosefrom_np(&m_files, childConnection + 1);
    ::posix_spawnattr_init(&m_attributes);
    sigset_t signals;
    ::sigemptyset(&signals);
    ::posix_spawnattr_setsigmask(&m_attributes, &signals);
    ::sigfillset(&signals);
    ::posix_spawnattr_setsigdefault(&m_attributes, &signals);
    ::posix_spawnattr_setflags(&m_attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF |
                                                  POSIX_SPAWN_SETPGROUP);
  }
  ~Beginning() {
    ::posix_spawnattr_destroy(&m_attributes);
    ::posix_spawn_file_actions_destroy(&m_files);
  }
  Beginning(const Beginning&) = delete;
  Beginning& operator=(const Beginning&) = delete;

  /// Starts the child for `job`; returns the process id, or 0: failed.
  pid_t spawn(std::string job) const {
    std::string program = "fenestra", word = subcommand, parent = std::to_string(::getpid());
    const std::array<char*, 5> arguments = {program.data(), word.data(), job.data(), parent.data(),
                                            nullptr};
    pid_t child = 0;
    const int failed =
        ::posix_spawn(&child, "/proc/self/exe", &m_files, &m_attributes, arguments.data(), environ);
    return failed ? 0 : child;
  }

private:
  posix_spawn_file_actions_t m_files;
  posix_spawnattr_t m_attributes;
};

} // namespace

ApartJob::ApartJob(std::string name, Answer answer, ApartLimits limits)
    : m_name(std::move(name)), m_answer(answer), m_limits(limits) {
  jobs().all.push_back(this);
}

void Apart::start() {
  if (!jobs().served)
    throw std::logic_error("main does not call serveApart");
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) == 0) {
    m_connection = Descriptor(ends[0]);
    m_child = Beginning(*Descriptor(ends[1])).spawn(m_job.name());
  }
  if (m_child != 0)
    return;
  end();
  throw outputError("memory", "no process can be started to read files in; close other programs");
}

void Apart::end() {
  if (m_child != 0) {
    ::kill(m_child, SIGKILL);
    repeated([this] { return ::waitpid(m_child, nullptr, 0); });
  }
  m_child = 0;
  m_connection = Descriptor();
}

std::optional<std::string> Apart::ask(const std::string& question, std::uint64_t most) {
  if (question.size() > longestQuestion)
    return std::nullopt;
  if (m_child == 0)
    start();
  constexpr unsigned byTheClock = 3;
  const auto deadline = Clock::now() + std::chrono::seconds(byTheClock * m_job.limits().seconds);
  std::optional<std::string> answer;
  if (sendFrame(*m_connection, question))
    answer = receiveFrame(*m_connection, most, deadline);
  if (!answer)
    end();
  return answer;
}

void serveApart(int argc, char** argv) {
  jobs().served = true;
  if (argc != 4 || std::string_view(argv[1]) != subcommand)
    return;
  for (const ApartJob* job : jobs().all)
    if (job->name() == argv[2] && confined(job->limits().bytes, argv[3]))
      answerAll(*job);
  ::_exit(1);
}

} // namespace fenestra
