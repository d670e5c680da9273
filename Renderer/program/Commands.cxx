#include "program/Commands.h"

#include "base/Error.h"
#include "program/BatchTable.h"
#include "program/CommandLine.h"
#include "program/ErrorAdvice.h"
#include "program/Help.h"
#include "program/Messages.h"
#include "program/RenderOptions.h"
#include "program/TurntableOptions.h"
#include "program/UsageError.h"

#include <filesystem>
#include <iostream>

namespace fenestra::core {
namespace {

constexpr Command subcommands[] = {
    {[]() -> const CommandSyntax& { return renderSyntax; }, renderCommand},
    {inspectSyntax, inspectCommand},
    {phantomSyntax, phantomCommand},
    {compareSyntax, compareCommand},
    {turntableSyntax, turntableCommand},
    {serveSyntax, serveCommand},
    {meshSyntax, meshCommand},
    {mergeSyntax, mergeCommand},
    {batchSyntax, batchCommand},
    {describeSyntax, describeCommand},
};

/// Throws Error (usage) for a word that names no file but resembles a command, or --version.
void rejectMisspelled(std::string_view word) {
  std::vector<std::string> names = {"--version"};
  for (const Command& command : commands())
    names.push_back(command.syntax().name);
  const std::string likely = findNearest(word, names);
  std::error_code failed;
  if (!likely.empty() && likely != word && !std::filesystem::exists(word, failed) && !failed)
    throw usageError("'", word, "': neither a file nor a command; did you mean fenestra ", likely,
                     "?");
}

} // namespace

std::span<const Command> commands() {
  return subcommands;
}

int dispatch(int argc, char** argv) {
  if (argc <= 1) {
    std::cerr << makeUsage();
    return exitStatus(ErrorKind::request);
  }
  const std::string_view given = argv[1];
  if (given == "help") {
    allowClosedOutput();
    std::cout << (argc > 2 ? makeTopicHelp(argv[2]) : makeOverview()) << std::flush;
    return 0;
  }
  const std::string_view word = given == "study" ? "batch" : given; // its name in version 0.1
  for (const auto& [syntax, run] : commands())
    if (word == syntax().name)
      return run(argc, argv, 2);
  rejectMisspelled(word);
  return renderCommand(argc, argv, 1);
}

} // namespace fenestra::core
