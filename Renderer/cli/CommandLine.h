#pragma once
// From arguments to values, by a command's syntax.

#include "cli/Flags.h"

#include <string_view>

namespace fenestra {

/// Parses argv[first …]: "--name value" and "--name=value" (a value that starts with "--" needs the
/// second form; negative numbers need nothing), positionals in between, "--" before positionals
/// that start with a dash. Prints help or version and returns nothing where they were asked for.
/// Throws Error (usage).
std::optional<FlagValues> parseCommandLine(const CommandSyntax& syntax, int argc, char** argv,
                                           int first);

/// What --help prints.
std::string helpText(const CommandSyntax& syntax);

/// The candidate that `word` is a likely misspelling of, or an abbreviation; empty where none is.
std::string_view nearest(std::string_view word, std::span<const std::string_view> candidates);

} // namespace fenestra
