#pragma once
// Subcommands, and a step that they share. Each takes the arguments from argv[first] on and returns
// the exit status; errors are thrown (base/Error.h) and reported by main.

namespace fenestra {

class FlagValues;

int renderCommand(int argc, char** argv, int first);
int inspectCommand(int argc, char** argv, int first);
int compareCommand(int argc, char** argv, int first);
int phantomCommand(int argc, char** argv, int first);
int mergeCommand(int argc, char** argv, int first);
int serveCommand(int argc, char** argv, int first);
int studyCommand(int argc, char** argv, int first);
int turntableCommand(int argc, char** argv, int first);

/// Threads that --threads asks for, at most one a core.
int threadCount(const FlagValues& flags);

/// Limits this process to --threads threads, at most one a core, and starts them before other code
/// uses threads; pins the instruction set that the environment variable FENESTRA_INSTRUCTIONS
/// names. Throws Error: usage if the machine lacks that instruction set, output if the threads
/// cannot be started.
void useMachine(const FlagValues& flags);

} // namespace fenestra
