#pragma once
// What renders may use of this machine.

#include "program/Flags.h"

namespace fenestra {

/// Holds all work of this process to the threads that --threads asks for, at most one a core, and
/// starts them, before anything else uses some; and pins the instruction set that the environment
/// variable FENESTRA_INSTRUCTIONS names. Throws Error (usage) where this machine does not have it,
/// (output) where it has no room for the threads.
void useMachine(const FlagValues& flags);

} // namespace fenestra
