#pragma once
// System calls on files: selects and describes them.

#include <span>
#include <string>

#include <sys/types.h>

struct user_regs_struct;
struct sock_filter;

namespace fenestra::core::faults {

/// seccomp filter that returns RET_TRACE for calls on files, including mmap of a file, and allows
/// all other calls.
std::span<const sock_filter> fileCallFilter();

/// True for renames, links, unlinks and writes, at which signals are injected.
bool isChange(const user_regs_struct& registers);

/// Description such as "openat /dev/shm/x/o.png" of the call that `thread` is about to execute.
std::string describeCall(pid_t thread, const user_regs_struct& registers);

} // namespace fenestra::core::faults
