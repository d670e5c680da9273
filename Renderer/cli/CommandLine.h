#pragma once
// From arguments to values, by a command's syntax.

#include "cli/Flags.h"

#include <string_view>

namespace fenestra {

/// Parses argv[first …] with CLI11: "--name value" or "--name=value", negative numbers as they are,
/// positionals in between. Prints help or version and returns nothing where they were asked for.
/// Throws Error (usage).
std::optional<FlagValues> parseCommandLine(const CommandSyntax& syntax, int argc, char** argv,
                                           int first);

/// The words of a text in lines of at most `width` characters; longer words have lines of their
/// own.
std::string wrapped(std::string_view text, std::size_t width);

/// The candidate that `word` is a likely misspelling of, or an abbreviation; empty where none is.
std::string_view nearest(std::string_view word, std::span<const std::string_view> candidates);

} // namespace fenestra
