#pragma once
// Commands, and steps that they share. A command parses argv[first …] and returns the exit status.
// Errors are thrown (base/Error.h); runProcess reports them.

#include <span>

namespace fenestra::core {

class OptionValues;
struct CommandSyntax;

struct Command {
  const CommandSyntax& (*syntax)();
  int (*run)(int argc, char** argv, int first);
};

/// All commands; the name of the first, render, is optional.
std::span<const Command> commands();

/// Runs the command that the first argument names, or else render.
int dispatch(int argc, char** argv);

const CommandSyntax& inspectSyntax();
const CommandSyntax& compareSyntax();
const CommandSyntax& phantomSyntax();
const CommandSyntax& meshSyntax();
const CommandSyntax& mergeSyntax();
const CommandSyntax& serveSyntax();
const CommandSyntax& describeSyntax();

int renderCommand(int argc, char** argv, int first);
int inspectCommand(int argc, char** argv, int first);
int compareCommand(int argc, char** argv, int first);
int phantomCommand(int argc, char** argv, int first);
int meshCommand(int argc, char** argv, int first);
int mergeCommand(int argc, char** argv, int first);
int serveCommand(int argc, char** argv, int first);
int batchCommand(int argc, char** argv, int first);
int turntableCommand(int argc, char** argv, int first);
int describeCommand(int argc, char** argv, int first);

/// Pins the instruction set that the environment variable FENESTRA_INSTRUCTIONS names. Throws Error
/// (usage) if the machine lacks it.
void pinInstructions();

/// Number of threads that --threads requests, at most one per core.
int threadCount(const OptionValues& options);

/// Limits this process to threadCount() threads, starts them before other code uses threads, and
/// pins the instruction set. Throws Error: as pinInstructions; output if the threads cannot be
/// started.
void configureMachine(const OptionValues& options);

} // namespace fenestra::core
