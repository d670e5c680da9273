#pragma once
// Subcommands, and steps that they share. Each takes the arguments from argv[first] on and returns
// the exit status; errors are thrown (base/Error.h) and reported by main.

#include <span>

namespace fenestra {

class OptionValues;
struct CommandSyntax;

struct Command {
  const CommandSyntax& (*syntax)();
  int (*run)(int argc, char** argv, int first);
};

/// All subcommands; the name of the first may be left out.
std::span<const Command> commands();

/// Runs the command that the first argument names, else a render.
int dispatch(int argc, char** argv);

const CommandSyntax& inspectSyntax();
const CommandSyntax& compareSyntax();
const CommandSyntax& phantomSyntax();
const CommandSyntax& mergeSyntax();
const CommandSyntax& serveSyntax();
const CommandSyntax& describeSyntax();

int renderCommand(int argc, char** argv, int first);
int inspectCommand(int argc, char** argv, int first);
int compareCommand(int argc, char** argv, int first);
int phantomCommand(int argc, char** argv, int first);
int mergeCommand(int argc, char** argv, int first);
int serveCommand(int argc, char** argv, int first);
int batchCommand(int argc, char** argv, int first);
int turntableCommand(int argc, char** argv, int first);
int describeCommand(int argc, char** argv, int first);

/// Pins the instruction set that the environment variable FENESTRA_INSTRUCTIONS names. Throws Error
/// (usage) if the machine lacks it.
void pinInstructions();

/// Threads that --threads asks for, at most one a core.
int threadCount(const OptionValues& options);

/// Limits this process to --threads threads, at most one a core, and starts them before other code
/// uses threads; pins the instruction set, too. Throws Error: as pinInstructions; output if the
/// threads cannot be started.
void configureMachine(const OptionValues& options);

} // namespace fenestra
