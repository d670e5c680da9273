// Sandboxed child process: its restrictions, crashes that would have ended this process, and
// invalid replies. The jobs below run in the child, which is this executable.

#include "io/Sandbox.h"

#include "ErrorChecks.h"
#include "TemporaryFolder.h"

#include <gtest/gtest.h>

#include <array>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <iostream>
#include <poll.h>
#include <stdexcept>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace fenestra::core::SandboxTests {
namespace {

constexpr std::uint64_t maxBytes = 1 << 20;
constexpr std::uint64_t memoryLimit = std::uint64_t{2} << 30;

const SandboxJob echoJob("test-echo", [](const std::string& request) { return request; });

/// Fails in the way that the request names.
std::string misbehave(const std::string& how) {
  if (how == "throw")
    throw std::runtime_error("no");
  if (how == "abort")
    std::abort();
  if (how == "segv")
    ::raise(SIGSEGV);
  if (how == "exit")
    std::_Exit(0);
  if (how == "print")
    std::cerr << "not for the user" << std::endl;
  if (how == "spin")
    while (::getpid() != 0)
      ;
  if (how == "sleep")
    for (;;)
      ::pause();
  if (how == "allocate")
    return std::string(3 * memoryLimit / 2, 'x');
  if (how == "pid")
    return std::to_string(::getpid());
  constexpr int connection = 3; // descriptor of the socket to the parent
  if (how == "half a frame" && ::write(connection, "\1\0\0", 3) == 3)
    std::_Exit(0);
  const std::uint64_t length = how == "endless frame" ? ~std::uint64_t{0} : 100;
  if (how.ends_with(" frame") && ::write(connection, &length, sizeof length) == sizeof length &&
      ::write(connection, "abc", 3) == 3)
    std::_Exit(0);
  return how;
}

const SandboxJob misbehavingJob("test-misbehave", misbehave, {1, memoryLimit});

TEST(Sandbox, RepliesWithinTheSizeLimits) {
  SandboxedReader child(echoJob);
  EXPECT_EQ(child.request("hello", maxBytes), "hello");
  const std::string large(60000, 'x');
  EXPECT_EQ(child.request(large, maxBytes), large);
  EXPECT_EQ(child.request("", maxBytes), "");
  EXPECT_EQ(child.request(std::string(1 << 17, 'x'), maxBytes), std::nullopt);
  EXPECT_EQ(child.request("hello", 4), std::nullopt);
  EXPECT_EQ(child.request("hello", 5), "hello");
}

TEST(Sandbox, SurvivesCrashesAndTimeoutsOfTheChild) {
  ::testing::internal::CaptureStderr();
  ::testing::internal::CaptureStdout();
  {
    SandboxedReader child(misbehavingJob);
    EXPECT_EQ(child.request("print", maxBytes), "print");
    EXPECT_EQ(child.request("throw", maxBytes), "");
    for (const char* how : {"abort", "segv", "exit", "spin", "sleep", "half a frame",
                            "endless frame", "short frame"}) {
      EXPECT_EQ(child.request(how, maxBytes), std::nullopt) << how;
      EXPECT_EQ(child.request("fine", maxBytes), "fine") << "after " << how;
    }
  }
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1) << "a child process remains";
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__clang__) // sanitizers map terabytes
TEST(Sandbox, ChildCannotExceedItsMemoryLimit) {
  SandboxedReader child(misbehavingJob);
  EXPECT_EQ(child.request("allocate", 2 * memoryLimit), "");
}

constexpr std::uint64_t requestLimit = 1 << 26;

/// Allocates as many bytes as the request says, within a limit of its own.
const SandboxJob limitedJob("test-limited", [](const std::string& bytes) {
  limitMemory(requestLimit);
  return std::to_string(std::string(std::stoull(bytes), 'x').size());
});

TEST(Sandbox, ARequestCanHaveALowerLimit) {
  SandboxedReader child(limitedJob);
  for (int i = 0; i < 3; ++i) { // a request that fails does not affect the next
    EXPECT_EQ(child.request(std::to_string(2 * requestLimit), maxBytes), "");
    const std::string half = std::to_string(requestLimit / 2);
    EXPECT_EQ(child.request(half, maxBytes), half);
  }
}
#endif

/// Lists the actions that the child is permitted, for the test below.
std::string listPermissions(const std::string& path) {
  std::string permissions;
  if (::open(path.c_str(), O_WRONLY | O_CREAT, 0600) >= 0)
    permissions += "created a file; ";
  for (int file = 0; file < 1024; ++file)
    if (file > 3 && ::fcntl(file, F_GETFD) >= 0)
      permissions += "inherited file " + std::to_string(file) + "; ";
  int files = 0;
  while (::open("/dev/null", O_RDONLY) >= 0)
    ++files;
  if (files > 32)
    permissions += "opened " + std::to_string(files) + " files; ";
  for (const auto limit : {RLIMIT_CORE, RLIMIT_FSIZE}) {
    rlimit now{};
    ::getrlimit(limit, &now);
    if (now.rlim_max != 0)
      permissions += "can write; ";
  }
  sigset_t blocked;
  ::sigprocmask(SIG_SETMASK, nullptr, &blocked);
  struct sigaction term {};
  ::sigaction(SIGTERM, nullptr, &term);
  if (::sigismember(&blocked, SIGINT) || term.sa_handler != SIG_DFL)
    permissions += "inherited signal settings; ";
  if (::getpgrp() != ::getpid())
    permissions += "is in its parent's process group; ";
  return permissions + "end";
}

const SandboxJob permissionsJob("test-allowed", listPermissions);

TEST(Sandbox, ChildInheritsNothingAndWritesNothing) {
  const TemporaryFolder folder;
  const std::string path = folder / "new";
  const int file = ::open("/dev/null", O_RDONLY); // inherited unless the child closes it
  sigset_t blocked, before;
  ::sigemptyset(&blocked);
  ::sigaddset(&blocked, SIGINT);
  ::pthread_sigmask(SIG_BLOCK, &blocked, &before);
  const auto handler = ::signal(SIGTERM, SIG_IGN);
  SandboxedReader child(permissionsJob);
  std::string permissions = child.request(path, maxBytes).value_or("no reply");
  ::signal(SIGTERM, handler);
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  ::close(file);
  // On kernels without Landlock the child can create a file, which stays empty.
  if (const std::string text = "created a file; "; permissions.starts_with(text)) {
    EXPECT_EQ(std::filesystem::file_size(path), 0u);
    permissions = permissions.substr(text.size());
  }
  EXPECT_EQ(permissions, "end");
}

TEST(Sandbox, FailedProcessStartIsAnOutputError) {
  rlimit before{};
  ::getrlimit(RLIMIT_NOFILE, &before);
  const rlimit none{0, before.rlim_max};
  SandboxedReader child(echoJob);
  ::setrlimit(RLIMIT_NOFILE, &none);
  catchError(ErrorKind::output, "out-of-memory: memory", [&] {
    try {
      child.request("hello", maxBytes);
    } catch (...) {
      ::setrlimit(RLIMIT_NOFILE, &before); // first: sanitizers inspect objects through a pipe
      throw;
    }
  });
  ::setrlimit(RLIMIT_NOFILE, &before);
  EXPECT_EQ(child.request("hello", maxBytes), "hello");
}

TEST(Sandbox, EveryThreadCanHaveAChild) {
  std::vector<std::thread> threads;
  std::array<int, 8> correct{};
  for (int& count : correct)
    threads.emplace_back([&count] {
      for (int i = 0; i < 4; ++i) {
        SandboxedReader child(echoJob);
        count += child.request(std::to_string(i), maxBytes) == std::to_string(i);
      }
    });
  for (std::thread& thread : threads)
    thread.join();
  for (const int count : correct)
    EXPECT_EQ(count, 4);
}

/// A process sends its child's pid to the test and then lets the child sleep. The test kills the
/// process.
TEST(Sandbox, ChildEndsWithItsParent) {
  std::array<int, 2> pipe{};
  ASSERT_EQ(::pipe(pipe.data()), 0);
  const pid_t parent = ::fork();
  if (parent == 0) {
    SandboxedReader child(misbehavingJob);
    const int pid = std::stoi(child.request("pid", maxBytes).value_or("0"));
    if (::write(pipe[1], &pid, sizeof pid) == sizeof pid)
      child.request("sleep", maxBytes);
    ::_exit(0);
  }
  pid_t child = 0;
  ASSERT_EQ(::read(pipe[0], &child, sizeof child), ssize_t{sizeof child});
  const int process = static_cast<int>(::syscall(SYS_pidfd_open, child, 0));
  ASSERT_GE(process, 0);
  ::kill(parent, SIGKILL);
  ::waitpid(parent, nullptr, 0);
  pollfd ended{process, POLLIN, 0};
  constexpr int timeout = 60'000; // ms; the child would sleep forever
  EXPECT_EQ(::poll(&ended, 1, timeout), 1);
  ::close(process);
  ::close(pipe[0]);
  ::close(pipe[1]);
}

std::string readPid(SandboxedReader& reader) {
  return reader.request("pid", maxBytes).value_or("none");
}

TEST(Sandbox, AnotherThreadStartsItsOwnChild) {
  SandboxedReader child(misbehavingJob);
  std::string first;
  std::thread([&] { first = readPid(child); }).join(); // the kernel kills the child of this thread
  const std::string second = readPid(child);
  EXPECT_NE(second, "none");
  EXPECT_NE(second, first);
  EXPECT_EQ(readPid(child), second);
}

TEST(Sandbox, AForkedProcessStartsItsOwnChild) {
  SandboxedReader child(misbehavingJob);
  const std::string before = readPid(child);
  const pid_t forked = ::fork();
  if (forked == 0) {
    const std::string own = readPid(child);
    ::_exit(own != before && own != "none" && readPid(child) == own ? 0 : 1);
  }
  int status = 0;
  ::waitpid(forked, &status, 0);
  EXPECT_EQ(status, 0);
  EXPECT_EQ(readPid(child), before);
}

TEST(Sandbox, AForkedProcessLeavesItsParentsChild) {
  auto child = std::make_unique<SandboxedReader>(misbehavingJob);
  const std::string before = readPid(*child);
  const pid_t forked = ::fork();
  if (forked == 0) {
    child.reset();
    ::_exit(0);
  }
  ::waitpid(forked, nullptr, 0);
  EXPECT_EQ(readPid(*child), before);
}

TEST(Sandbox, TheProgramMayIgnoreEndedChildrenOrWaitForThem) {
  const auto handler = ::signal(SIGCHLD, SIG_IGN);
  for (const char* how : {"segv", "sleep"}) {
    SandboxedReader child(misbehavingJob);
    EXPECT_EQ(child.request(how, maxBytes), std::nullopt) << how;
    EXPECT_EQ(child.request("fine", maxBytes), "fine") << how;
  }
  ::signal(SIGCHLD, handler);
  SandboxedReader child(misbehavingJob);
  const int pid = std::stoi(readPid(child));
  ::kill(pid, SIGKILL);
  ASSERT_EQ(::waitpid(-1, nullptr, 0), pid);
  EXPECT_EQ(child.request("fine", maxBytes), std::nullopt);
  EXPECT_EQ(child.request("fine", maxBytes), "fine");
}

/// Counts its requests.
struct Counter {
  int count = 0;
  std::string operator()(const std::string&) { return std::to_string(++count); }
};
const SandboxJob countingJob("test-count", Counter());

TEST(Sandbox, ReadsInThisProcessIfTheCallerAllowsIt) {
  const std::string pid = std::to_string(::getpid());
  SandboxedReader child(misbehavingJob);
  EXPECT_NE(readPid(child), pid);
  {
    const InProcessReading inProcess;
    { const InProcessReading nested; }
    EXPECT_EQ(readPid(child), pid);
    EXPECT_EQ(child.request("throw", maxBytes), "");
    EXPECT_EQ(child.request("too long", 3), std::nullopt);
    EXPECT_EQ(child.request(std::string(1 << 17, 'x'), maxBytes), std::nullopt);
    std::string other;
    std::thread([&] {
      other = SandboxedReader(misbehavingJob).request("pid", maxBytes).value();
    }).join();
    EXPECT_NE(other, pid) << "another thread did not allow it";
  }
  EXPECT_NE(readPid(child), pid);
}

TEST(Sandbox, EachReaderHasItsOwnHandler) {
  const auto countTwice = [] {
    SandboxedReader reader(countingJob);
    std::string counts = reader.request("", maxBytes).value_or("none");
    return counts += reader.request("", maxBytes).value_or("none");
  };
  EXPECT_EQ(countTwice(), "12");
  const InProcessReading inProcess;
  EXPECT_EQ(countTwice(), "12");
  EXPECT_EQ(countTwice(), "12");
}

TEST(Sandbox, ReadingInThisProcessLeavesItsMemoryLimit) {
  rlimit before{}, after{};
  ::getrlimit(RLIMIT_AS, &before);
  limitMemory(1 << 20);
  ::getrlimit(RLIMIT_AS, &after);
  EXPECT_EQ(after.rlim_cur, before.rlim_cur);
}

TEST(ReplyReader, ReturnsTheValuesThatWereWritten) {
  ReplyWriter writer;
  writer.put("text");
  writer.put(std::vector<double>{1.5, -2.0});
  writer.put("");
  writer.put(std::vector<double>{});
  ReplyReader reader(writer.bytes());
  EXPECT_EQ(reader.text(), "text");
  EXPECT_EQ(reader.numbers(), (std::vector<double>{1.5, -2.0}));
  EXPECT_EQ(reader.text(), "");
  EXPECT_FALSE(reader.isAtEnd());
  EXPECT_TRUE(reader.numbers().empty());
  EXPECT_TRUE(reader.isAtEnd());
}

TEST(ReplyReader, RejectsTruncatedAndOverlongReplies) {
  ReplyWriter writer;
  writer.put(std::vector<double>{1.0, 2.0});
  const std::string& complete = writer.bytes();
  for (std::size_t length = 0; length < complete.size(); ++length)
    EXPECT_THROW(ReplyReader(complete.substr(0, length)).numbers(), std::runtime_error) << length;
  for (const std::uint64_t count : {std::uint64_t{17}, std::uint64_t{1} << 61, ~std::uint64_t{0}}) {
    std::string changed = complete;
    std::memcpy(changed.data(), &count, sizeof count);
    EXPECT_THROW(ReplyReader(changed).numbers(), std::runtime_error) << count;
    EXPECT_THROW(ReplyReader(changed).text(), std::runtime_error) << count;
  }
  ReplyWriter infinite;
  infinite.put(std::vector<double>{std::numeric_limits<double>::infinity()});
  EXPECT_THROW(ReplyReader(infinite.bytes()).numbers(), std::runtime_error);
}

} // namespace
} // namespace fenestra::core::SandboxTests
