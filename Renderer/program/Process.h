#pragma once
// Framework of every process of this program: streams, signals, errors, temporary files.

namespace fenestra::core {

/// Runs the command that the arguments name, and returns the exit status. May throw Error.
using DispatchFunction = int (*)(int argc, char** argv);

/// Opens closed standard streams, handles signals, runs `dispatch`, reports errors, removes
/// temporary files, and ends the process.
[[noreturn]] void runProcess(int argc, char** argv, DispatchFunction dispatch);

} // namespace fenestra::core
