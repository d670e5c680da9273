#include "base/Error.h"
#include "io/MessageText.h"
#include "program/CommandLine.h"
#include "program/Commands.h"
#include "program/Describe.h"
#include "program/Messages.h"
#include "program/UsageError.h"

#include <iostream>
#include <map>

namespace fenestra::core {
namespace {

const std::map<std::string, std::string (*)()> descriptions = {
    {"bash", makeBashCompletions},
    {"fish", makeFishCompletions},
    {"man", makeManPage},
    {"zsh", makeZshCompletions},
};

} // namespace

const CommandSyntax& describeSyntax() {
  static const CommandSyntax syntax = {
      "describe",
      "Prints the manual page, or a script with which a shell completes fenestra's commands, "
      "options and their values.",
      {{"KIND", "man (the manual page), bash, zsh or fish", {"man", "bash", "zsh", "fish"}}},
      {},
      {},
      "Print the manual page or shell completions",
      "describe man | man -l -",
  };
  return syntax;
}

int describeCommand(int argc, char** argv, int first) {
  const std::optional<OptionValues> values = parseCommandLine(describeSyntax(), argc, argv, first);
  if (!values)
    return 0;
  const std::string kind = *values->text("KIND");
  const auto description = descriptions.find(kind);
  if (description == descriptions.end())
    throw usageError("KIND: '", toOneLine(kind), "' is unknown; use man, bash, zsh or fish");
  allowClosedOutput();
  std::cout << description->second() << std::flush;
  return 0;
}

} // namespace fenestra::core
