#include "io/platform/ChildProcess.h"
#include "io/platform/SharedSlot.h"

#include <gtest/gtest.h>

#include <csignal>
#include <iostream>
#include <thread>

#include <fcntl.h>
#include <unistd.h>

namespace fenestra::core::ChildProcessTests {
namespace {

/// Arguments that run one of the disabled cases below.
std::vector<std::string> makeArguments(const std::string& testCase) {
  return {"--gtest_also_run_disabled_tests", "--gtest_filter=ChildProcess.DISABLED_" + testCase};
}

void waitFor(ChildProcess& child) {
  while (!child.hasEnded())
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

TEST(ChildProcess, DISABLED_Prints) {
  std::cerr << "printed by the child\n";
}
TEST(ChildProcess, DISABLED_Fails) {
  FAIL();
}
TEST(ChildProcess, DISABLED_Crashes) {
  std::cerr << std::string(70'000, 'x') << "the end\n";
  ::kill(::getpid(), SIGKILL);
}
TEST(ChildProcess, DISABLED_Sleeps) {
  for (;;)
    ::pause();
}
/// Standard input is empty, and no file of the parent is open.
TEST(ChildProcess, DISABLED_InheritsNoFiles) {
  EXPECT_EQ(std::cin.get(), EOF);
  for (int file = 3; file < 64; ++file)
    EXPECT_LT(::fcntl(file, F_GETFD), 0) << file;
}

/// The result of the parent is in the inherited slot, and only of its own key and size.
TEST(ChildProcess, DISABLED_ReadsTheSlot) {
  const auto slot = SharedSlot::findInherited();
  ASSERT_TRUE(slot);
  std::string bytes(5, '.');
  EXPECT_FALSE(slot->read(8, bytes));
  EXPECT_FALSE(slot->read(7, std::span(bytes).first(4)));
  EXPECT_EQ(slot->read(7, bytes), (SharedSlot::Numbers{1.5, -2.0}));
  EXPECT_EQ(bytes, "voxel");
  slot->write(9, {}, std::string("child"));
  for (int file = ChildProcess::inheritedFile + 1; file < 64; ++file)
    EXPECT_TRUE(::fcntl(file, F_GETFD) < 0 || file == *slot->file()) << file;
}

TEST(ChildProcess, InheritsASlot) {
  EXPECT_FALSE(SharedSlot::findInherited());
  const SharedSlot slot;
  std::string bytes(5, '.');
  EXPECT_FALSE(slot.read(0, bytes)) << "empty";
  slot.write(7, {1.5, -2.0}, std::string("voxel"));
  ChildProcess child(makeArguments("ReadsTheSlot"), 4, &slot.file());
  waitFor(child);
  EXPECT_EQ(child.status(), 0) << child.errors();
  EXPECT_FALSE(slot.read(7, bytes));
  EXPECT_TRUE(slot.read(9, bytes));
  EXPECT_EQ(bytes, "child");
}

TEST(ChildProcess, ReportsHowItEnded) {
  const std::vector<std::pair<std::string, int>> cases = {
      {"Prints", 0}, {"Fails", 1}, {"Crashes", 128 + SIGKILL}, {"InheritsNoFiles", 0}};
  for (const auto& [testCase, status] : cases) {
    ChildProcess child(makeArguments(testCase), 4);
    waitFor(child);
    EXPECT_EQ(child.status(), status) << testCase << child.errors();
    if (testCase == "Prints") {
      EXPECT_EQ(child.errors(), "printed by the child\n");
    }
    if (testCase == "Crashes") {
      EXPECT_TRUE(child.errors().ends_with("xthe end\n"));
      EXPECT_EQ(child.errors().size(), 1U << 16U) << "only the end is kept";
    }
  }
}

TEST(ChildProcess, EndsOnASignalAndWhenDestroyed) {
  ChildProcess child(makeArguments("Sleeps"), 4);
  child.send(SIGTERM);
  waitFor(child);
  EXPECT_EQ(child.status(), 128 + SIGTERM);
  { const ChildProcess other(makeArguments("Sleeps"), 4); }
}

} // namespace
} // namespace fenestra::core::ChildProcessTests
