// Work in a process of its own: done, not done, and what would have ended this one.

#include "io/Apart.h"

#include <gtest/gtest.h>

#include <csignal>
#include <cstring>
#include <iostream>
#include <stdexcept>

namespace fenestra {
namespace {

TEST(Apart, givesWhatItWasFilledWith) {
  EXPECT_EQ(filledApart(5,
                        [](char* place) {
                          std::memcpy(place, "hello", 5);
                          return true;
                        }),
            "hello");
  constexpr std::size_t large = std::size_t{1} << 26;
  const auto zeros = filledApart(large, [](char*) { return true; });
  ASSERT_TRUE(zeros);
  EXPECT_EQ(zeros->size(), large);
}

TEST(Apart, leavesThisProcessAsItWas) {
  int here = 1;
  EXPECT_TRUE(filledApart(1, [&here](char*) {
    here = 2;
    return true;
  }));
  EXPECT_EQ(here, 1);
}

TEST(Apart, survivesWhateverHappensThere) {
  testing::internal::CaptureStderr();
  EXPECT_FALSE(filledApart(8, [](char*) { return false; }));
  EXPECT_FALSE(filledApart(8, [](char*) -> bool { throw std::runtime_error("no"); }));
  EXPECT_FALSE(filledApart(8, [](char*) -> bool { std::abort(); }));
  EXPECT_FALSE(filledApart(8, [](char*) {
    ::raise(SIGSEGV);
    return true;
  }));
  EXPECT_FALSE(filledApart(8, [](char*) -> bool { std::_Exit(3); }));
  EXPECT_FALSE(filledApart(8, [](char*) {
    std::cerr << "not for the user" << std::endl;
    return false;
  }));
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

} // namespace
} // namespace fenestra
