#pragma once
// Subcommands. Each takes the arguments after its own name and returns the exit status; errors are
// thrown (base/Error.h) and reported by main.

namespace fenestra {

int renderCommand(int argc, char** argv, int first);
int inspectCommand(int argc, char** argv, int first);
int compareCommand(int argc, char** argv, int first);
int phantomCommand(int argc, char** argv, int first);
int serveCommand(int argc, char** argv, int first);
int turntableCommand(int argc, char** argv, int first);

} // namespace fenestra
