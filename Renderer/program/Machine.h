#pragma once
// Use of this machine's cores and instruction sets.

#include "program/Flags.h"

namespace fenestra {

/// Limits this process to --threads threads, at most one a core, and starts them before other code
/// uses threads; pins the instruction set that the environment variable FENESTRA_INSTRUCTIONS
/// names. Throws Error: usage if the machine lacks that instruction set, output if the threads
/// cannot be started.
void useMachine(const FlagValues& flags);

} // namespace fenestra
