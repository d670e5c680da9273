#include "cli/CommandLine.h"
#include "cli/Commands.h"
#include "core/Error.h"

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <new>
#include <string>
#include <string_view>

namespace {

using Command = int (*)(int argc, char** argv, int first);

struct NamedCommand {
  std::string_view name;
  Command run;
};

constexpr NamedCommand commands[] = {
    {"render", fenestra::renderCommand},   {"inspect", fenestra::inspectCommand},
    {"compare", fenestra::compareCommand}, {"phantom", fenestra::phantomCommand},
    {"serve", fenestra::serveCommand},     {"turntable", fenestra::turntableCommand},
};

/// A word alone that is nearly a subcommand and no file is meant as one.
void refuseMisspelt(std::string_view word) {
  std::vector<std::string_view> names;
  for (const NamedCommand& command : commands)
    names.push_back(command.name);
  const std::string_view likely = fenestra::nearest(word, names);
  if (!likely.empty() && !std::filesystem::exists(word))
    throw fenestra::usageError("'" + std::string(word) +
                               "': neither a file nor a subcommand; did you mean fenestra " +
                               std::string(likely) + "?");
}

int dispatch(int argc, char** argv) {
  const std::string_view word = argc > 1 ? argv[1] : "";
  const auto* named =
      std::find_if(std::begin(commands), std::end(commands),
                   [word](const NamedCommand& command) { return command.name == word; });
  if (named != std::end(commands))
    return named->run(argc, argv, 2);
  refuseMisspelt(word);
  return fenestra::renderCommand(argc, argv, 1);
}

/// Whatever an exception says, on one line.
int fail(int status, std::string line) {
  std::replace(line.begin(), line.end(), '\n', ' ');
  std::cerr << "fenestra: " << line << std::endl;
  return status;
}

} // namespace

int main(int argc, char** argv) {
  using fenestra::ErrorKind;
  try {
    return dispatch(argc, argv);
  } catch (const fenestra::Error& error) {
    return fail(error.exitStatus(), error.what());
  } catch (const std::bad_alloc&) {
    return fail(static_cast<int>(ErrorKind::output),
                "out of memory; use a smaller volume or picture");
  } catch (const std::exception& error) {
    return fail(static_cast<int>(ErrorKind::output), error.what());
  }
}
