#pragma once
// Memory shared by the test program and Preload.cxx in the process under test.

#include <atomic>
#include <cstdint>

namespace fenestra::core::faults {

/// Environment variable with the path of the page's file.
inline constexpr const char* pageVariable = "FENESTRA_FAULTS_PAGE";

/// The system call lseek(-1, 0, mainMarker), which fails, signals to the tracer that `main` starts.
inline constexpr int mainMarker = 0x4d41;

struct Frame {
  char module[200];       ///< path of the executable or library
  char function[300];     ///< mangled exported symbol; empty: none
  std::uintptr_t address; ///< offset in the module
};

struct Page {
  std::atomic<std::int64_t> allocations; ///< allocations since the start of `main`
  std::int64_t failingNumber;            ///< number of the failing allocation, from 1; 0: none
  std::atomic<int> signal;               ///< signal that ended the process; 0: none
  int frameCount;
  Frame frames[40]; ///< stack of the thread that received the signal, innermost first
};

} // namespace fenestra::core::faults
