#include "io/platform/ChildProcess.h"

#include "base/Error.h"
#include "io/platform/SelfExec.h"
#include "io/platform/SystemErrors.h"

#include <algorithm>
#include <csignal>
#include <fcntl.h>
#include <string_view>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

namespace fenestra::core {
namespace {

/// Executes the program, in the child. Async-signal-safe, since other threads may have held locks
/// at the fork. Signals are blocked on entry, so that the parent's handlers do not run here.
[[noreturn]] void execProgram(pid_t parent, int errors, const Descriptor* inherited,
                              char* const* arguments, int failureStatus) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) // the parent died before PR_SET_PDEATHSIG
    ::_exit(1);
  ::setpgid(0, 0);
  const int devNull = ::open("/dev/null", O_RDWR);
  ::dup2(devNull, STDIN_FILENO);
  ::dup2(devNull, STDOUT_FILENO);
  ::dup2(errors, STDERR_FILENO);
  if (inherited && **inherited != ChildProcess::inheritedFile)
    ::dup2(**inherited, ChildProcess::inheritedFile);
  else if (inherited)
    ::fcntl(**inherited, F_SETFD, 0); // not closed by exec
  ::closefrom(inherited ? ChildProcess::inheritedFile + 1 : STDERR_FILENO + 1);
  for (int signal = 1; signal < NSIG; ++signal) {
    struct sigaction action = {};
    if (::sigaction(signal, nullptr, &action) == 0 && action.sa_handler != SIG_IGN)
      ::signal(signal, SIG_DFL);
  }
  sigset_t none;
  ::sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  ::execv(selfExecutable, arguments);
  constexpr std::string_view line =
      "fenestra: error: memory: cannot start another process; close other programs\n";
  [[maybe_unused]] const auto written = ::write(STDERR_FILENO, line.data(), line.size());
  ::_exit(failureStatus);
}

} // namespace

ChildProcess::ChildProcess(std::vector<std::string> arguments, int failureStatus,
                           const Descriptor* inherited)
    : m_errors(::memfd_create("errors", MFD_CLOEXEC)) {
  const ArgumentList selfArguments(makeSelfArguments(std::move(arguments)));
  const pid_t parent = ::getpid();
  ::signal(SIGCHLD, SIG_DFL); // if it were ignored, the child's status would be lost
  sigset_t all, before;
  ::sigfillset(&all);
  ::pthread_sigmask(SIG_BLOCK, &all, &before);
  m_id = m_errors.isOpen() ? ::fork() : -1;
  if (m_id == 0)
    execProgram(parent, *m_errors, inherited, selfArguments.get(), failureStatus);
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  if (m_id < 0)
    throw outputError(ErrorCode::outOfMemory, "memory",
                      "cannot start another process; close other programs");
}

ChildProcess::~ChildProcess() {
  if (m_id == 0)
    return;
  send(SIGKILL);
  retryOnEintr([this] { return ::waitpid(m_id, nullptr, 0); });
}

bool ChildProcess::hasEnded() {
  int state = 0;
  if (m_id == 0)
    return true;
  if (retryOnEintr([&] { return ::waitpid(m_id, &state, WNOHANG); }) != m_id)
    return false;
  m_id = 0;
  m_status = WIFEXITED(state) ? WEXITSTATUS(state) : 128 + WTERMSIG(state);
  return true;
}

void ChildProcess::send(int signal) const {
  if (m_id != 0)
    ::kill(m_id, signal);
}

std::string ChildProcess::errors() const {
  constexpr off_t maxBytes = 1 << 16;
  struct stat file = {};
  ::fstat(*m_errors, &file);
  std::string text(static_cast<std::size_t>(std::min<off_t>(file.st_size, maxBytes)), '\0');
  const auto from = file.st_size - static_cast<off_t>(text.size());
  const auto read =
      retryOnEintr([&] { return ::pread(*m_errors, text.data(), text.size(), from); });
  text.resize(static_cast<std::size_t>(std::max<ssize_t>(read, 0)));
  return text;
}

} // namespace fenestra::core
