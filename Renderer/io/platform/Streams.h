#pragma once
// The standard streams of a program.

#include <cstddef>
#include <string_view>

namespace fenestra::core {

/// Opens closed standard streams, so that no file gets their descriptors. Reads find an empty file;
/// writes to /dev/full fail, as they would have.
void openStandardStreams();

/// Writes to standard error in one call, so that no other process writes in between. Ignores
/// failures. Async-signal-safe.
void writeToStandardError(std::string_view text);

bool isStandardErrorTerminal();
/// Width of the terminal in characters, which the user may change; 80: unknown.
std::size_t queryTerminalWidth();

/// True if standard output is a pipe without a reader.
bool isStandardOutputClosed();

} // namespace fenestra::core
