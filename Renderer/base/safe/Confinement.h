#pragma once
// Confinement of a process before it reads untrusted files. For Apart.cxx.

#include <cstdint>

namespace fenestra {

/// Limits this process for good: `bytes` of address space (not under sanitizers, which map
/// terabytes), 32 open files, no growing file, no core; with Landlock (Linux 5.13) no right to
/// write, make, remove or execute files. Lets the kernel kill this process when its parent dies.
/// False where process number `parent` is gone already, or a limit cannot be set.
bool confined(std::uint64_t bytes, const char* parent);

/// Lets the kernel kill this process once it has used `seconds` more of processor time.
void allowSeconds(unsigned seconds);

} // namespace fenestra
