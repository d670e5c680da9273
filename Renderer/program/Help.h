#pragma once
// What --help prints of a command.

#include "program/Flags.h"

#include <string>
#include <string_view>

namespace fenestra {

/// Summary, positional arguments and flags by group, in lines of 80 characters.
std::string helpText(const CommandSyntax& syntax);

/// The words of a text in lines of at most `width` characters; longer words have lines of their
/// own.
std::string wrapped(std::string_view text, std::size_t width);

} // namespace fenestra
