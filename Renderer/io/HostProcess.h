#pragma once
// The process that a library runs in.

namespace fenestra::core {

/// True in a process that was forked, without executing a program, from one in which this function
/// was called before.
bool isForkedHost();

} // namespace fenestra::core
