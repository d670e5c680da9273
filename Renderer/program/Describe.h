#pragma once
// The command line told to other programs, from the tables of flags: to man, and to shells, which
// complete commands, flags, and their values.

#include <string>

namespace fenestra {

/// Manual page in the language mdoc.
std::string manPage();

/// Scripts that a shell reads, by bash 4, zsh and fish 3.
std::string bashCompletions();
std::string zshCompletions();
std::string fishCompletions();

} // namespace fenestra
