#pragma once
// Time and memory of a command.

#include "base/Stopwatch.h"
#include "base/Vector.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

namespace fenestra::core {

struct Cost {
  double seconds = infinity, cpuSeconds = infinity; ///< of the processes
  double peakMegabytes = infinity;                  ///< in 10^6 bytes

  void keepMinimum(const Cost& other) {
    seconds = std::min(seconds, other.seconds);
    cpuSeconds = std::min(cpuSeconds, other.cpuSeconds);
    peakMegabytes = std::min(peakMegabytes, other.peakMegabytes);
  }
};

/// Runs a command without its output, with the children that it waits for. Throws
/// std::runtime_error if it fails.
inline Cost measureCost(const std::vector<std::string>& command) {
  std::vector<char*> arguments;
  for (const std::string& word : command)
    arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  const Stopwatch watch;
  const pid_t child = fork();
  if (child == 0) {
    dup2(open("/dev/null", O_WRONLY), STDOUT_FILENO);
    execv(arguments[0], arguments.data());
    _exit(127);
  }
  int status = -1;
  rusage usage{};
  if (child < 0 || wait4(child, &status, 0, &usage) != child || status != 0)
    throw std::runtime_error(command.front() + " failed");
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return {watch.seconds(), seconds(usage.ru_utime) + seconds(usage.ru_stime),
          1024e-6 * static_cast<double>(usage.ru_maxrss)};
}

} // namespace fenestra::core
