// Renders on a system that starts no more threads, as at a user's process limit (ulimit -u).

#include "CommandTesting.h"

#include <cerrno>
#include <cstddef>
#include <cstdlib>
#include <iostream>
#include <thread>

#include <linux/filter.h>
#include <linux/sched.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/syscall.h>

namespace fenestra::core::ThreadsCommandTests {
namespace {

using ThreadsCommand = SmallScene;

/// Makes thread creation fail in this process and its children; new processes still start. Uses
/// seccomp, since RLIMIT_NPROC does not apply to root.
bool forbidThreads() {
  // The last two numbers of a jump: instructions to skip if its test is true, and if it is false.
  constexpr auto refused = SECCOMP_RET_ERRNO | EAGAIN;
  sock_filter filter[] = {
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_clone3, 3, 0),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_clone, 0, 3),
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, args[0])),
      BPF_JUMP(BPF_JMP | BPF_JSET | BPF_K, CLONE_THREAD, 0, 1),
      BPF_STMT(BPF_RET | BPF_K, refused),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
  };
  const sock_fprog program = {std::size(filter), filter};
  return ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
         ::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0;
}

/// Ends without calling destructors, since the parent still uses the temporary folders.
[[noreturn]] void runWithoutThreads(Arguments arguments, const std::filesystem::path& folder) {
  if (!forbidThreads())
    std::_Exit(77);
  for (const char* word : {"--size", "8x8", "--samples", "1", "--progress", "xml"})
    arguments.emplace_back(word);
  const Outcome outcome = run(arguments, folder);
  std::cerr << outcome.err;
  std::_Exit(outcome.status);
}

TEST_F(ThreadsCommand, FailedThreadStartIsAnErrorAndOneThreadRenders) {
  if (std::thread::hardware_concurrency() < 2)
    GTEST_SKIP() << "needs more than one core";
  if (::prctl(PR_GET_SECCOMP) < 0)
    GTEST_SKIP() << "needs seccomp";
  const Arguments render = {"volume.nrrd", "--output", "a.png", "--threads"};
  const Arguments turntable = {"turntable", "volume.nrrd", "--output",  "t.png",
                               "--frames",  "1",           "--threads", "1"};
  const auto withThreads = [&render](const char* threads) {
    Arguments arguments = render;
    arguments.emplace_back(threads);
    return arguments;
  };
  EXPECT_EXIT(runWithoutThreads(withThreads("2"), folder.path()), ::testing::ExitedWithCode(4),
              "^fenestra: error: threads: [^\n]*--threads 1\n$");
  EXPECT_FALSE(std::filesystem::exists(folder / "a.png"));
  EXPECT_EXIT(runWithoutThreads(withThreads("1"), folder.path()), ::testing::ExitedWithCode(0),
              "^$");
  EXPECT_TRUE(std::filesystem::exists(folder / "a.png"));
  EXPECT_EXIT(runWithoutThreads(turntable, folder.path()), ::testing::ExitedWithCode(0), "^$");
  EXPECT_TRUE(std::filesystem::exists(folder / "t_0000.png"));
}

} // namespace
} // namespace fenestra::core::ThreadsCommandTests
