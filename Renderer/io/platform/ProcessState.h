#pragma once
// Signals, resources and end of this process.

#include <cstdint>
#include <initializer_list>

namespace fenestra::core {

/// Lets `handler` handle these signals, one at a time; those that are ignored stay ignored (nohup).
void handleSignals(std::initializer_list<int> signals, void (*handler)(int));

/// Waits until another thread ends the process.
[[noreturn]] void waitForEnd();

/// True in a process that was forked, without executing a program, from one in which this function
/// was called before.
bool isForkedProcess();

/// Resources that this process has used so far.
struct ResourceUsage {
  double cpuSeconds = 0.0; ///< s, of all threads
  std::int64_t peakBytes = 0;
};
ResourceUsage readResourceUsage();

} // namespace fenestra::core
