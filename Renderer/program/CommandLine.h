#pragma once
// Conversion of arguments to flag values, by a command's syntax, and its help.

#include "program/Options.h"

#include <string_view>

namespace fenestra {

/// Switches that every command takes, whatever else it is given.
extern const std::span<const Option> commonOptions;

/// Parses argv[first …]: "--name value" or "--name=value", positionals in between; after "--", only
/// positionals. A value may begin with one dash, as negative numbers do. If --help or --version is
/// among the words, prints the text (of the version as JSON if --json is, too) and returns nullopt,
/// whatever else is wrong. Throws Error (usage).
std::optional<OptionValues> parseCommandLine(const CommandSyntax& syntax, int argc, char** argv,
                                             int first);

/// True if two commands take the same flag.
inline bool isSameOption(const Option& a, const Option& b) {
  return a.name == b.name && a.placeholder == b.placeholder && a.description == b.description;
}

/// Candidate that `word` probably misspells or abbreviates; empty: none.
std::string findNearest(std::string_view word, std::span<const std::string> candidates);
std::vector<std::string> listNames(std::span<const Option> options);

/// Flags that the command takes, in the table's order.
std::vector<Option> listOptions(const CommandSyntax& syntax);

} // namespace fenestra
