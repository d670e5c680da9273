#pragma once
// Parts of the benchmark programs: CPU time, and the end of a program by an error.

#include "base/Error.h"

#include <sys/resource.h>

#include <exception>
#include <iostream>

namespace fenestra::benchmarks {

/// User and system time of this process so far.
inline double cpuSeconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

/// Exit status of main(): of the benchmark, or of the error that it throws, which is told.
inline int runBenchmark(const char* name, int (*benchmark)(int, char**), int argc, char** argv) {
  try {
    return benchmark(argc, argv);
  } catch (const Error& error) {
    std::cerr << name << ": " << error.what() << '\n';
    return error.exitStatus();
  } catch (const std::exception& error) {
    std::cerr << name << ": " << error.what() << '\n';
    return 1;
  }
}

} // namespace fenestra::benchmarks
