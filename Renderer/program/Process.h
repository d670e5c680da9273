#pragma once
// Frame of every process of this program: streams, stops, errors, temporary files.

namespace fenestra {

/// Runs what the arguments say, and returns the exit status; may throw Error.
using DispatchFunction = int (*)(int argc, char** argv);

/// Runs `dispatch` between opening and closing streams, handles stops, reports errors, removes
/// temporary files, and ends the process.
[[noreturn]] void runProcess(int argc, char** argv, DispatchFunction dispatch);

} // namespace fenestra
