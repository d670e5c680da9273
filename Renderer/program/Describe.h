#pragma once
// The command line told to other programs, from the tables of flags: to man, and to shells, which
// complete commands, flags, and their values.

#include <string>

namespace fenestra {

/// Manual page in the language mdoc.
std::string makeManPage();

/// Scripts that a shell reads, by bash 4, zsh and fish 3.
std::string makeBashCompletions();
std::string makeZshCompletions();
std::string makeFishCompletions();

} // namespace fenestra
