#pragma once
// System calls that touch files: their selection and their description.

#include <span>
#include <string>

#include <sys/types.h>

struct user_regs_struct;
struct sock_filter;

namespace fenestra::faults {

/// Filter that stops with RET_TRACE at calls that touch files, a file's mmap included; other calls
/// pass.
std::span<const sock_filter> fileCallFilter();

/// True for renames, links, unlinks and writes: calls that a signal must not interrupt.
bool isCommitting(const user_regs_struct& registers);

/// Text such as "openat /dev/shm/x/o.png" for a thread stopped before the call.
std::string describeCall(pid_t thread, const user_regs_struct& registers);

} // namespace fenestra::faults
