#pragma once
// Help texts, generated from the tables of commands and options.

#include "program/Options.h"

#include <string>
#include <string_view>

namespace fenestra::core {

/// Five lines for a command line without arguments.
std::string makeUsage();

/// Commands, the options that matter first, examples and exit statuses, in at most 60 lines.
std::string makeOverview();

/// Help on `topic`: a group of render's options (renderGroups), all of them ("all"), or a command.
/// Throws Error (usage) for any other word.
std::string makeTopicHelp(std::string_view topic);
bool isHelpTopic(std::string_view topic);

/// Summary, example, positional arguments, and options by group.
std::string makeCommandHelp(const CommandSyntax& syntax);

} // namespace fenestra::core
