#pragma once
// System calls that touch files: which they are, and what one of them was about.

#include <span>
#include <string>

#include <sys/types.h>

struct user_regs_struct;
struct sock_filter;

namespace fenestra::faults {

/// Stops, with RET_TRACE, at calls that touch files, a file's mmap among them; lets others pass.
std::span<const sock_filter> fileCallFilter();

/// Renames, links, unlinks and writes: what a signal must not come between.
bool isCommitting(const user_regs_struct& registers);

/// "openat /dev/shm/x/o.png", of a thread that is stopped before the call.
std::string described(pid_t thread, const user_regs_struct& registers);

} // namespace fenestra::faults
