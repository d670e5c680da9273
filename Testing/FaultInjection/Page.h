#pragma once
// Memory shared by the test program and the library preloaded into the process under test.

#include <atomic>
#include <cstdint>

namespace fenestra::faults {

/// Environment variable that holds the page's file, for the preloaded library.
inline constexpr const char* pageVariable = "FENESTRA_FAULTS_PAGE";

/// Argument of the system call that marks the start of `main`: lseek(-1, 0, mainMarker), which
/// fails.
inline constexpr int mainMarker = 0x4d41;

struct Frame {
  char module[200];       ///< path of the executable or library
  char function[300];     ///< exported symbol, mangled; empty: none
  std::uintptr_t address; ///< offset in the module
};

struct Page {
  std::atomic<std::int64_t> allocations; ///< requests since `main` began
  std::int64_t failingNumber;            ///< number of the failing allocation, from 1; 0: none
  std::atomic<int> signal;               ///< signal that ended the process; 0: none
  int frameCount;
  Frame frames[40]; ///< stack of the thread that received the signal, innermost first
};

} // namespace fenestra::faults
