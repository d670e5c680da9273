#pragma once
// From arguments to values, by a command's syntax.

#include "program/Flags.h"

#include <string_view>

namespace fenestra {

/// Parses argv[first …]: "--name value" or "--name=value", positionals in between; after "--", only
/// positionals. A value may begin with one dash, as negative numbers do. Prints help or version and
/// returns nothing where they were asked for, whatever else is wrong.
/// Throws Error (usage).
std::optional<FlagValues> parseCommandLine(const CommandSyntax& syntax, int argc, char** argv,
                                           int first);

/// The candidate that `word` is a likely misspelling of, or an abbreviation; empty where none is.
std::string_view nearest(std::string_view word, std::span<const std::string_view> candidates);

} // namespace fenestra
