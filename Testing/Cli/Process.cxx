#include "Process.h"

#include "RunSettings.h"
#include "base/Stopwatch.h"

#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <regex>
#include <stdexcept>
#include <thread>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

namespace fenestra {
namespace {

/// Time limit of a process in seconds.
double getTimeLimit() {
  return 30.0 * static_cast<double>(testing::slowdownFactor());
}

/// Content of a file. Opens it again, since reading through `file` would move the child's position.
std::string readContent(int file) {
  const std::ifstream stream("/proc/self/fd/" + std::to_string(file), std::ios::binary);
  return {std::istreambuf_iterator<char>(stream.rdbuf()), {}};
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

} // namespace

Process::Process(const Arguments& arguments, const std::filesystem::path& folder, Stdout target)
    : m_out(::memfd_create("out", MFD_CLOEXEC)), m_err(::memfd_create("err", MFD_CLOEXEC)) {
  int in[2], unread[2];
  if (m_out < 0 || m_err < 0 || ::pipe2(in, O_CLOEXEC) != 0 || ::pipe2(unread, O_CLOEXEC) != 0)
    throw std::runtime_error("cannot create files for a process");
  ::close(unread[0]);
  m_id = ::fork();
  if (m_id < 0)
    throw std::runtime_error("cannot start a process");
  if (m_id == 0)
    execProgram(arguments, folder, in[0],
                target == Stdout::file         ? m_out
                : target == Stdout::closedPipe ? unread[1]
                                               : ::open("/dev/full", O_WRONLY),
                m_err);
  ::close(in[0]);
  ::close(unread[1]);
  m_in = in[1];
}

Process::~Process() {
  if (isRunning()) {
    ::kill(m_id, SIGKILL);
    ::waitpid(m_id, nullptr, 0);
  }
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

void Process::send(int signal) const {
  if (isRunning())
    ::kill(m_id, signal);
}

bool Process::waitUntilHandling(int signal) const {
  return waitUntil(
      [&] {
        std::ifstream status("/proc/" + std::to_string(m_id) + "/status");
        for (std::string line; std::getline(status, line);)
          if (line.starts_with("SigCgt:"))
            return (std::strtoull(line.c_str() + std::strlen("SigCgt:"), nullptr, 16) >>
                        (signal - 1) &
                    1) != 0;
        return false;
      },
      10.0);
}

bool Process::waitForOutput(const std::string& expression) const {
  const std::regex pattern(expression);
  return waitUntil([&] { return std::regex_search(readContent(m_out), pattern); }, getTimeLimit());
}

Outcome Process::wait() {
  const Stopwatch watch;
  waitUntil([] { return false; }, getTimeLimit());
  Outcome outcome;
  outcome.seconds = watch.seconds();
  if (isRunning()) {
    ::kill(m_id, SIGKILL);
    ::waitpid(m_id, &m_waitStatus, 0);
    m_ended = true;
  }
  if (WIFEXITED(m_waitStatus))
    outcome.status = WEXITSTATUS(m_waitStatus);
  outcome.out = readContent(m_out);
  outcome.err = readContent(m_err);
  const std::size_t begin =
      outcome.err.starts_with("look: ") ? 0 : outcome.err.find("\nlook: ") + 1;
  if (outcome.err.compare(begin, 6, "look: ") == 0) {
    const std::size_t end = outcome.err.find('\n', begin);
    outcome.statusLine = outcome.err.substr(begin, end - begin);
    outcome.err.erase(begin, end - begin + 1);
  }
  return outcome;
}

bool Process::isRunning() const {
  if (!m_ended)
    m_ended = ::waitpid(m_id, &m_waitStatus, WNOHANG) == m_id;
  return !m_ended;
}

bool Process::waitUntil(const std::function<bool()>& condition, double limit) const {
  for (const Stopwatch watch; isRunning() && watch.seconds() < limit;) {
    if (condition())
      return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return false;
}

Outcome run(const Arguments& arguments, const std::filesystem::path& folder) {
  return Process(arguments, folder).wait();
}

} // namespace fenestra
