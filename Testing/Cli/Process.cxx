#include "Process.h"

#include "base/Stopwatch.h"

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <limits>
#include <regex>
#include <stdexcept>
#include <thread>
#include <tuple>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

namespace fenestra::core {
namespace {

/// Content of a file. Opens it again, since reading through `file` would move the child's position.
std::string readContent(int file) {
  const std::ifstream stream("/proc/self/fd/" + std::to_string(file), std::ios::binary);
  return {std::istreambuf_iterator<char>(stream.rdbuf()), {}};
}

/// Moves the last line that is no error and no warning to `result`. A bar may precede it.
void splitResult(Outcome& outcome) {
  constexpr std::string_view eraser = "\033[K";
  std::string& text = outcome.err = outcome.messages;
  for (std::size_t end = text.rfind('\n'); end != text.npos && end > 0;) {
    const std::size_t before = text.rfind('\n', end - 1);
    std::size_t begin = before == text.npos ? 0 : before + 1;
    const std::size_t bar = text.substr(begin, end - begin).rfind(eraser);
    begin += bar == text.npos ? 0 : bar + eraser.size();
    if (text.compare(begin, 8, "fenestra") != 0) {
      outcome.result = text.substr(begin, end + 1 - begin);
      text.erase(begin, end + 1 - begin);
      return;
    }
    end = before;
  }
}

[[noreturn]] void execProgram(const Arguments& arguments, const std::filesystem::path& folder,
                              int in, int out, int err) {
  std::vector<char*> words = {const_cast<char*>(FENESTRA_EXECUTABLE)};
  for (const std::string& argument : arguments)
    words.push_back(const_cast<char*>(argument.c_str()));
  words.push_back(nullptr);
  if (::chdir(folder.c_str()) == 0 && ::dup2(in, STDIN_FILENO) >= 0 &&
      ::dup2(out, STDOUT_FILENO) >= 0 && ::dup2(err, STDERR_FILENO) >= 0)
    ::execv(FENESTRA_EXECUTABLE, words.data());
  ::_exit(127);
}

/// Opens a terminal that changes no characters. Returns its two ends: ours and the program's.
std::pair<int, int> openTerminal() {
  const int ours = ::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
  if (ours < 0 || ::grantpt(ours) != 0 || ::unlockpt(ours) != 0)
    throw std::runtime_error("cannot open a terminal");
  const int programs = ::open(::ptsname(ours), O_RDWR | O_NOCTTY | O_CLOEXEC);
  termios mode = {};
  if (programs < 0 || ::tcgetattr(programs, &mode) != 0)
    throw std::runtime_error("cannot open a terminal");
  ::cfmakeraw(&mode);
  ::tcsetattr(programs, TCSANOW, &mode);
  return {ours, programs};
}

/// Copies until no process has the terminal open any more; closes `terminal`.
void copyTerminal(int terminal, int file) {
  char part[1024];
  for (ssize_t count; (count = ::read(terminal, part, sizeof part)) > 0;)
    [[maybe_unused]] const auto written = ::write(file, part, static_cast<std::size_t>(count));
  ::close(terminal);
}

} // namespace

Process::Process(const Arguments& arguments, const std::filesystem::path& folder, Stdout out,
                 Stderr err)
    : m_out(::memfd_create("out", MFD_CLOEXEC)), m_err(::memfd_create("err", MFD_CLOEXEC)) {
  int in[2], unread[2];
  if (m_out < 0 || m_err < 0 || ::pipe2(in, O_CLOEXEC) != 0 || ::pipe2(unread, O_CLOEXEC) != 0)
    throw std::runtime_error("cannot create files for a process");
  ::close(unread[0]);
  int terminal = -1, shown = m_err;
  if (err == Stderr::terminal)
    std::tie(terminal, shown) = openTerminal();
  m_id = ::fork();
  if (m_id < 0)
    throw std::runtime_error("cannot start a process");
  if (m_id == 0)
    execProgram(arguments, folder, in[0],
                out == Stdout::file         ? m_out
                : out == Stdout::closedPipe ? unread[1]
                                            : ::open("/dev/full", O_WRONLY),
                shown);
  if (terminal >= 0) {
    ::close(shown);
    m_terminal = std::jthread(copyTerminal, terminal, m_err);
  }
  ::close(in[0]);
  ::close(unread[1]);
  m_in = in[1];
}

Process::~Process() {
  if (isRunning()) {
    ::kill(m_id, SIGKILL);
    reap(0);
  }
  if (m_terminal.joinable())
    m_terminal.join();
  closeInput();
  ::close(m_out);
  ::close(m_err);
}

void Process::write(const std::string& text) const {
  if (::write(m_in, text.data(), text.size()) != static_cast<ssize_t>(text.size()))
    throw std::runtime_error("cannot write to a process");
}

void Process::closeInput() {
  if (m_in >= 0)
    ::close(m_in);
  m_in = -1;
}

std::string Process::output() const {
  return readContent(m_out);
}

std::string Process::messages() const {
  return readContent(m_err);
}

void Process::send(int signal) const {
  if (isRunning())
    ::kill(m_id, signal);
}

bool Process::waitUntilHandling(int signal) const {
  return waitUntil([&] {
    std::ifstream status("/proc/" + std::to_string(m_id) + "/status");
    for (std::string line; std::getline(status, line);)
      if (line.starts_with("SigCgt:"))
        return (std::strtoull(line.c_str() + std::strlen("SigCgt:"), nullptr, 16) >> (signal - 1) &
                1) != 0;
    return false;
  });
}

bool Process::waitUntilOpen(const std::filesystem::path& file) const {
  return waitUntil([&] {
    namespace fs = std::filesystem;
    std::error_code ignored; // of descriptors that are closed meanwhile
    return std::ranges::any_of(
        fs::directory_iterator("/proc/" + std::to_string(m_id) + "/fd", ignored),
        [&](const auto& entry) { return fs::equivalent(entry.path(), file, ignored); });
  });
}

bool Process::waitForOutput(const std::string& expression) const {
  const std::regex pattern(expression);
  return waitUntil([&] { return std::regex_search(readContent(m_out), pattern); });
}

double Process::cpuSeconds() const {
  std::ifstream file("/proc/" + std::to_string(m_id) + "/stat");
  file.ignore(std::numeric_limits<std::streamsize>::max(), ')'); // the name may contain spaces
  std::string skipped;
  for (int field = 3; field < 14; ++field)
    file >> skipped;
  double ticks = 0.0;
  for (int field = 14; field < 18; ++field) { // user and system time, of itself and of its children
    double more = 0.0;
    file >> more;
    ticks += more;
  }
  return ticks / static_cast<double>(::sysconf(_SC_CLK_TCK));
}

bool Process::waitForMessage(const std::string& expression) const {
  const std::regex pattern(expression);
  return waitUntil([&] { return std::regex_search(messages(), pattern); });
}

Outcome Process::wait() {
  const double before = cpuSeconds();
  waitUntil([] { return false; });
  if (isRunning()) {
    ::kill(m_id, SIGKILL);
    reap(0);
  }
  if (m_terminal.joinable())
    m_terminal.join();
  Outcome outcome;
  outcome.cpuSeconds = m_cpuSeconds - before;
  if (WIFEXITED(m_waitStatus))
    outcome.status = WEXITSTATUS(m_waitStatus);
  outcome.out = readContent(m_out);
  outcome.messages = readContent(m_err);
  splitResult(outcome);
  return outcome;
}

bool Process::isRunning() const {
  reap(WNOHANG);
  return !m_ended;
}

void Process::reap(int flags) const {
  rusage usage = {};
  if (m_ended || ::wait4(m_id, &m_waitStatus, flags, &usage) != m_id)
    return;
  m_ended = true;
  for (const timeval& time : {usage.ru_utime, usage.ru_stime})
    m_cpuSeconds += static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

bool Process::waitUntil(const std::function<bool()>& condition) const {
  for (const Stopwatch watch; isRunning() && watch.seconds() < hangLimit;) {
    if (condition())
      return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return condition();
}

Outcome run(const Arguments& arguments, const std::filesystem::path& folder) {
  return Process(arguments, folder).wait();
}

} // namespace fenestra::core
