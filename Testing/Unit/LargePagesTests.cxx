#include "base/LargePages.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <fstream>
#include <sstream>
#include <string>

using namespace fenestra::core;

namespace {

/// Flags (VmFlags of /proc/self/smaps) of the mapping that contains an address; empty: none does.
std::string readFlags(const void* address) {
  std::ifstream maps("/proc/self/smaps");
  const auto target = reinterpret_cast<std::uintptr_t>(address);
  bool isFound = false;
  for (std::string line; std::getline(maps, line);) {
    std::istringstream words(line);
    std::uintptr_t begin = 0, end = 0;
    char dash = 0;
    if (words >> std::hex >> begin >> dash >> end && dash == '-')
      isFound = begin <= target && target < end;
    else if (isFound && line.starts_with("VmFlags:"))
      return line + ' ';
  }
  return {};
}

std::uintptr_t toInteger(const void* address) {
  return reinterpret_cast<std::uintptr_t>(address);
}

} // namespace

TEST(LargePages, AreRequestedForArraysThatFillThem) {
  constexpr std::size_t page = std::size_t{2} << 20;
  const LargeArray<float> large(3 * page / sizeof(float) + 1, 1.0F);
  EXPECT_EQ(toInteger(large.data()) % page, 0U);
  const std::string flags = readFlags(large.data());
  if (flags.empty())
    GTEST_SKIP() << "/proc/self/smaps is not available";
  if (!std::ifstream("/sys/kernel/mm/transparent_hugepage/enabled"))
    GTEST_SKIP() << "the system does not support large pages";
  EXPECT_NE(flags.find(" hg "), std::string::npos) << flags;
}

TEST(LargePages, SmallArraysStartAtACacheLine) {
  for (const std::size_t size : std::array<std::size_t, 3>{1, 15, 4096})
    EXPECT_EQ(toInteger(LargeArray<char>(size).data()) % 64, 0U) << size;
}

TEST(LargePages, ArraysThatAreTooLargeAreRejected) {
  LargePages<double> pages;
  EXPECT_THROW((void)pages.allocate(static_cast<std::size_t>(-1) / 4), std::bad_alloc);
}
