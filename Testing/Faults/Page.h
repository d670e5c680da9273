#pragma once
// Memory that the program and the library preloaded into the process under test share.

#include <atomic>
#include <cstdint>

namespace fenestra::faults {

/// Names the file that is the page, to the preloaded library.
inline constexpr const char* pageVariable = "FENESTRA_FAULTS_PAGE";

/// Mark of a system call that says that `main` begins: lseek(-1, 0, mainBegins), which fails.
inline constexpr int mainBegins = 0x4d41;

struct Frame {
  char module[200];       ///< path of the executable or library
  char function[300];     ///< its exported symbol, mangled; empty where it has none
  std::uintptr_t address; ///< in the module
};

struct Page {
  std::atomic<std::int64_t> allocations; ///< asked for since `main` began
  std::int64_t failing;                  ///< number of the one that fails, from 1; 0 for none
  std::atomic<int> signal;               ///< that ended the process; 0 where none did
  int frameCount;
  Frame frames[40]; ///< of the thread that the signal met, innermost first
};

} // namespace fenestra::faults
