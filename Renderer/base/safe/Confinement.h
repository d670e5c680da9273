#pragma once
// What a process gives up before it reads what nobody trusts. For Apart.cxx.

#include <cstdint>

namespace fenestra {

/// Leaves this process `bytes` of address space (not under sanitizers, which map terabytes), 32
/// open files, none of which may grow, no core, and where the kernel has Landlock (5.13) no right
/// to change what is in any folder; it dies with the process whose number `parent` is. False where
/// that is gone already, or a limit cannot be set.
bool confined(std::uint64_t bytes, const char* parent);

/// Ends the process that takes more of a processor from now on.
void allowSeconds(unsigned seconds);

} // namespace fenestra
