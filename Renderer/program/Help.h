#pragma once
// Text of --help for a command.

#include "program/Flags.h"

#include <string>
#include <string_view>

namespace fenestra {

/// Summary, positional arguments and flags by group, in lines of 80 characters.
std::string helpText(const CommandSyntax& syntax);

/// Words of `text` in lines of at most `width` characters; a longer word has its own line.
std::string wrapped(std::string_view text, std::size_t width);

} // namespace fenestra
