#pragma once
// Parsing of a command's arguments, and its --help.

#include "program/Options.h"

#include <string_view>

namespace fenestra::core {

/// Switches that every command accepts: --help (-h) and --version.
extern const std::span<const Option> commonOptions;

/// Parses argv[first …]: "--name value", "--name=value" or "-x value" (of an integer also "-x4"),
/// mixed with positional arguments; only positional ones after "--". A value may begin with one
/// dash, as negative numbers do, unless it is a short option. If --help or --version is present,
/// prints that text (the version as JSON with --json; for `fenestra --help` without a command the
/// overview, or the help on the topic that follows) and returns nullopt, even if other arguments
/// are invalid. Throws Error (usage).
std::optional<OptionValues> parseCommandLine(const CommandSyntax& syntax, int argc, char** argv,
                                             int first);

/// True if two commands share the option.
inline bool isSameOption(const Option& a, const Option& b) {
  return a.name == b.name && a.placeholder == b.placeholder && a.description == b.description;
}

/// Canonical name of the option that `word` probably misspells; empty: none.
std::string findLikelyOption(std::string_view word, std::span<const Option> options);

/// Options that the command accepts, in table order.
std::vector<Option> listOptions(const CommandSyntax& syntax);

} // namespace fenestra::core
