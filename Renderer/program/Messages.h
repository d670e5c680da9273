#pragma once
// Text for people: warnings, results and the progress bar, on standard error. One writer, from any
// thread, so that each line is complete and never mixed with the bar.

#include <string>
#include <string_view>

namespace fenestra::core {

/// Later lines go to standard output, since Slicer reports all text on standard error as an error.
void printLinesToOutput();

/// Prints one line; control characters in it are replaced.
void printLine(std::string_view line);
/// "fenestra: warning: …"
void printWarning(std::string_view warning);

/// Shows this text, which must fit into the terminal's width, instead of the previous bar. Lines
/// are printed above it.
void showBar(const std::string& bar);
void eraseBar();
/// Characters that erase a shown bar; empty without one. Async-signal-safe.
std::string_view barEraser();

/// Closing standard output early, as `| head` does, is no error for this command: the process then
/// ends quietly with status 0. Call before printing text that was asked for.
void allowClosedOutput();
bool isClosedOutputAllowed();

} // namespace fenestra::core
