#include "Tracer.h"

#include "Calls.h"

#include <cerrno>
#include <condition_variable>
#include <csignal>
#include <fstream>
#include <map>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>

#include <fcntl.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/ptrace.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/user.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

namespace fenestra::core::faults {
namespace {

constexpr rlim_t cpuLimit = 20;                     ///< limit of a run's processor time in seconds
constexpr auto hangLimit = std::chrono::minutes(5); ///< of a run that waits, even on a busy machine

/// File in memory.
class MemoryFile {
public:
  explicit MemoryFile(const char* name) : m_file(::memfd_create(name, MFD_CLOEXEC)) {
    if (m_file < 0)
      throw std::runtime_error("memfd_create failed");
  }
  ~MemoryFile() { ::close(m_file); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  int number() const { return m_file; }
  /// Path of the file for this process and its children, valid while this process runs.
  std::string path() const {
    return "/proc/" + std::to_string(::getpid()) + "/fd/" + std::to_string(m_file);
  }
  std::string content() const {
    const std::ifstream stream(path(), std::ios::binary);
    return {std::istreambuf_iterator<char>(stream.rdbuf()), {}};
  }

private:
  int m_file;
};

class SharedPage {
public:
  SharedPage() {
    if (::ftruncate(m_file.number(), sizeof(Page)) != 0)
      throw std::runtime_error("cannot create shared memory");
    m_page = static_cast<Page*>(
        ::mmap(nullptr, sizeof(Page), PROT_READ | PROT_WRITE, MAP_SHARED, m_file.number(), 0));
    if (m_page == MAP_FAILED)
      throw std::runtime_error("cannot create shared memory");
  }
  ~SharedPage() { ::munmap(m_page, sizeof(Page)); }
  SharedPage(const SharedPage&) = delete;
  SharedPage& operator=(const SharedPage&) = delete;

  Page* operator->() const { return m_page; }
  std::string path() const { return m_file.path(); }

private:
  MemoryFile m_file{"page"};
  Page* m_page;
};

/// Kills a process at hangLimit.
class Watchdog {
public:
  explicit Watchdog(pid_t process)
      : m_thread([this, process] {
          std::unique_lock lock(m_mutex);
          if (m_wake.wait_for(lock, hangLimit, [this] { return m_ended; }))
            return;
          m_hasKilled = true;
          ::kill(process, SIGKILL);
        }) {}
  ~Watchdog() { end(); }
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;

  /// Stops the watchdog. True if it has killed the process.
  bool end() {
    {
      const std::lock_guard lock(m_mutex);
      m_ended = true;
    }
    m_wake.notify_one();
    if (m_thread.joinable())
      m_thread.join();
    return m_hasKilled;
  }

private:
  std::mutex m_mutex;
  std::condition_variable m_wake;
  bool m_ended = false, m_hasKilled = false;
  std::thread m_thread;
};

/// Data for the child, prepared before the fork since the child must not allocate.
struct Start {
  Start(const Command& command, const SharedPage& page) : folder(command.folder) {
    variables = {"TMPDIR=" + command.temporary.string(), "LD_PRELOAD=" + command.preload.string(),
                 std::string(pageVariable) + "=" + page.path()}; // the first of equal names is used
    for (char** variable = environ; *variable; ++variable)
      variables.emplace_back(*variable);
    for (const std::string& word : command.arguments)
      arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    for (const std::string& variable : variables)
      environment.push_back(const_cast<char*>(variable.c_str()));
    environment.push_back(nullptr);
  }

  std::filesystem::path folder;
  std::vector<std::string> variables;
  std::vector<char*> arguments, environment;
};

[[noreturn]] void execCommand(const Start& start, int out, int err, const Fault& fault,
                              bool traced) {
  const std::span<const sock_filter> filter = fileCallFilter();
  const sock_fprog program = {static_cast<unsigned short>(filter.size()),
                              const_cast<sock_filter*>(filter.data())};
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  const int in = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  for (const int stop : {SIGHUP, SIGQUIT, SIGINT, SIGTERM, SIGPIPE}) // nohup ignores SIGHUP
    ::signal(stop, SIG_DFL);
  if (fault.kind == Fault::Kind::ignored)
    ::signal(fault.value, SIG_IGN);
  const rlimit processorTime = {cpuLimit, cpuLimit}; // ends the process by SIGKILL
  ::setrlimit(RLIMIT_CPU, &processorTime);
  const bool isReady = ::chdir(start.folder.c_str()) == 0 && ::dup2(in, STDIN_FILENO) >= 0 &&
                       ::dup2(out, STDOUT_FILENO) >= 0 && ::dup2(err, STDERR_FILENO) >= 0;
  if (isReady && traced)
    traced = ::ptrace(PTRACE_TRACEME, 0, nullptr, nullptr) == 0 && ::raise(SIGSTOP) == 0 &&
             ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
             ::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0;
  if (isReady)
    ::execve(start.arguments[0], start.arguments.data(), start.environment.data());
  ::_exit(127);
}

/// Process id of a thread.
pid_t findProcess(pid_t thread) {
  std::ifstream status("/proc/" + std::to_string(thread) + "/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("Tgid:"))
      return static_cast<pid_t>(std::strtol(line.c_str() + 5, nullptr, 10));
  return thread;
}

/// Traces a process, its threads and its children.
class Trace {
public:
  Trace(pid_t root, const Fault& fault, Outcome& outcome)
      : m_root(root), m_fault(fault), m_outcome(outcome) {}

  /// Traces until all processes have ended.
  void follow() {
    int state = 0;
    rusage usage = {};
    for (pid_t thread; (thread = ::wait4(-1, &state, __WALL | __WNOTHREAD, &usage)) > 0;) {
      if (WIFSTOPPED(state))
        ::ptrace(PTRACE_CONT, thread, nullptr, handleStop(thread, state));
      else if (thread == m_root) {
        m_outcome.peakKilobytes = usage.ru_maxrss;
        m_outcome.hasTimedOut =
            usage.ru_utime.tv_sec + usage.ru_stime.tv_sec >= time_t{cpuLimit} - 1;
        onEnd(state);
      }
    }
  }

private:
  /// Handles a stopped thread; returns the signal to continue it with.
  long handleStop(pid_t thread, int state) {
    const int event = state >> 16;
    if (event == PTRACE_EVENT_SECCOMP)
      onCall(thread);
    else if (event == PTRACE_EVENT_EXEC)
      m_started.erase(findProcess(thread));
    else if (event == PTRACE_EVENT_FORK || event == PTRACE_EVENT_VFORK)
      onFork(thread);
    else if (event == 0 && WSTOPSIG(state) != SIGSTOP)
      return WSTOPSIG(state);
    return 0;
  }

  void onFork(pid_t thread) {
    unsigned long child = 0;
    if (::ptrace(PTRACE_GETEVENTMSG, thread, nullptr, &child) != 0)
      return;
    m_children.push_back(static_cast<pid_t>(child));
    if (m_started.contains(process(thread)))
      m_started.insert(static_cast<pid_t>(child));
  }

  pid_t process(pid_t thread) {
    const auto [entry, isNew] = m_processes.try_emplace(thread, 0);
    if (isNew)
      entry->second = findProcess(thread);
    return entry->second;
  }

  void onCall(pid_t thread) {
    user_regs_struct registers = {};
    if (::ptrace(PTRACE_GETREGS, thread, nullptr, &registers) != 0)
      return;
    if (registers.orig_rax == SYS_lseek && registers.rdx == mainMarker)
      m_started.insert(process(thread));
    else if (m_started.contains(process(thread)))
      onFileCall(thread, registers);
  }

  void onFileCall(pid_t thread, user_regs_struct& registers) {
    ++m_outcome.calls;
    m_outcome.changes += isChange(registers) ? 1 : 0;
    if (m_fault.kind == Fault::Kind::call && m_outcome.calls == m_fault.number) {
      m_outcome.place = describeCall(thread, registers);
      registers.orig_rax = ~0ULL; // skips the call
      registers.rax = static_cast<unsigned long long>(-static_cast<long long>(m_fault.value));
      ::ptrace(PTRACE_SETREGS, thread, nullptr, &registers);
    }
    const bool signals =
        m_fault.kind == Fault::Kind::signal || m_fault.kind == Fault::Kind::ignored;
    if (signals && isChange(registers) && m_outcome.changes == m_fault.number) {
      m_outcome.place = describeCall(thread, registers);
      if (process(thread) == m_root)
        ::syscall(SYS_tgkill, m_root, thread, m_fault.value);
      else
        ::kill(m_root, m_fault.value);
    }
  }

  void onEnd(int state) {
    m_outcome.status = WIFEXITED(state) ? WEXITSTATUS(state) : -1;
    m_outcome.signal = WIFSIGNALED(state) ? WTERMSIG(state) : 0;
    for (const pid_t child : m_children)
      ::kill(child, SIGKILL);
  }

  pid_t m_root;
  const Fault& m_fault;
  Outcome& m_outcome;
  std::set<pid_t> m_started;          ///< processes in which `main` has started
  std::map<pid_t, pid_t> m_processes; ///< process id per thread
  std::vector<pid_t> m_children;
};

/// Waits until the child stops itself, then lets it run traced.
bool attach(pid_t child) {
  int state = 0;
  constexpr long options = PTRACE_O_TRACESECCOMP | PTRACE_O_TRACEFORK | PTRACE_O_TRACEVFORK |
                           PTRACE_O_TRACECLONE | PTRACE_O_TRACEEXEC | PTRACE_O_EXITKILL;
  return ::waitpid(child, &state, __WALL) == child && WIFSTOPPED(state) &&
         ::ptrace(PTRACE_SETOPTIONS, child, nullptr, options) == 0 &&
         ::ptrace(PTRACE_CONT, child, nullptr, 0) == 0;
}

} // namespace

bool canTrace() {
  const pid_t child = ::fork();
  if (child == 0) {
    const std::span<const sock_filter> filter = fileCallFilter();
    const sock_fprog program = {static_cast<unsigned short>(filter.size()),
                                const_cast<sock_filter*>(filter.data())};
    ::_exit(::ptrace(PTRACE_TRACEME, 0, nullptr, nullptr) == 0 && ::raise(SIGSTOP) == 0 &&
                    ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
                    ::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0
                ? 0
                : 1);
  }
  int state = 0;
  if (!attach(child)) {
    ::kill(child, SIGKILL);
    ::waitpid(child, &state, 0);
    return false;
  }
  while (::waitpid(child, &state, __WALL) == child && WIFSTOPPED(state))
    ::ptrace(PTRACE_CONT, child, nullptr, 0);
  return WIFEXITED(state) && WEXITSTATUS(state) == 0;
}

Outcome run(const Command& command, const Fault& fault) {
  const SharedPage page;
  const MemoryFile out("out"), err("err");
  const Start start(command, page);
  const bool traced = fault.kind != Fault::Kind::none && fault.kind != Fault::Kind::allocation;
  if (fault.kind == Fault::Kind::allocation)
    page->failingNumber = fault.number;
  Outcome outcome;
  const pid_t child = ::fork();
  if (child == 0)
    execCommand(start, out.number(), err.number(), fault, traced);
  if (child < 0 || (traced && !attach(child)))
    throw std::runtime_error("cannot start or trace a process");
  Watchdog watchdog(child);
  Trace(child, fault, outcome).follow();
  outcome.hasTimedOut |= watchdog.end();
  outcome.errors = err.content();
  const std::string root = command.folder.parent_path().string() + "/";
  if (const std::size_t at = outcome.place.find(root); at != outcome.place.npos)
    outcome.place.erase(at, root.size());
  outcome.allocations = page->allocations;
  if (page->failingNumber != 0 && page->allocations >= page->failingNumber)
    outcome.place = "allocation";
  if (page->signal != 0)
    outcome.frames.assign(page->frames, page->frames + page->frameCount);
  return outcome;
}

} // namespace fenestra::core::faults
