#pragma once
// Parts of the benchmark programs: CPU time, and error handling of main().

#include "program/Commands.h"
#include "program/ErrorAdvice.h"

#include <sys/resource.h>

#include <exception>
#include <iostream>

namespace fenestra::core::benchmarks {

/// User and system time that this process has used.
inline double cpuSeconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

/// Runs a benchmark with the instruction set of FENESTRA_INSTRUCTIONS, prints the error that it
/// throws, and returns the exit status for main().
inline int runBenchmark(const char* name, int (*benchmark)(int, char**), int argc, char** argv) {
  try {
    pinInstructions();
    return benchmark(argc, argv);
  } catch (const Error& error) {
    std::cerr << name << ": " << error.what() << '\n';
    return exitStatus(error.kind());
  } catch (const std::exception& error) {
    std::cerr << name << ": " << error.what() << '\n';
    return 1;
  }
}

} // namespace fenestra::core::benchmarks
