#pragma once
// Manual page and shell completions, generated from the tables of options, so that they match this
// version. Shells complete commands, options and option values.

#include <string>

namespace fenestra::core {

/// Manual page in mdoc format.
std::string makeManPage();

/// Scripts for bash 4, zsh and fish 3.
std::string makeBashCompletions();
std::string makeZshCompletions();
std::string makeFishCompletions();

} // namespace fenestra::core
