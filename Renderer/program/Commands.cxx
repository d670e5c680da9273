#include "program/Commands.h"

#include "base/Error.h"
#include "program/BatchTable.h"
#include "program/CommandLine.h"
#include "program/RenderOptions.h"
#include "program/TurntableOptions.h"
#include "program/UsageError.h"

#include <filesystem>

namespace fenestra {
namespace {

constexpr Command subcommands[] = {
    {[]() -> const CommandSyntax& { return renderSyntax; }, renderCommand},
    {inspectSyntax, inspectCommand},
    {turntableSyntax, turntableCommand},
    {batchSyntax, batchCommand},
    {mergeSyntax, mergeCommand},
    {serveSyntax, serveCommand},
    {compareSyntax, compareCommand},
    {phantomSyntax, phantomCommand},
    {describeSyntax, describeCommand},
};

/// Throws Error (usage) for a word that names no file but resembles a command.
void rejectMisspelled(std::string_view word) {
  std::vector<std::string> names;
  for (const Command& command : commands())
    names.push_back(command.syntax().name);
  const std::string likely = findNearest(word, names);
  std::error_code failed;
  if (!likely.empty() && !std::filesystem::exists(word, failed) && !failed)
    throw usageError("'", word, "': neither a file nor a command; did you mean fenestra ", likely,
                     "?");
}

} // namespace

std::span<const Command> commands() {
  return subcommands;
}

int dispatch(int argc, char** argv) {
  const std::string_view given = argc > 1 ? argv[1] : "";
  const std::string_view word = given == "study" ? "batch" : given; // its name in version 0.1
  for (const auto& [syntax, run] : commands())
    if (word == syntax().name)
      return run(argc, argv, 2);
  rejectMisspelled(word);
  return renderCommand(argc, argv, 1);
}

} // namespace fenestra
