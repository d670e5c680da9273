#include "program/ShellCommand.h"

#include "base/Text.h"
#include "io/MessageText.h"

#include <nlohmann/json.hpp>

namespace fenestra::core {

std::string quoteForShell(const std::string& argument) {
  const char* const plain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_@%+=:,./-";
  if (!argument.empty() && argument.find_first_not_of(plain) == std::string::npos)
    return argument;
  return concat("'", replaceAll(argument, "'", "'\\''"), "'");
}

std::string formatExample(const nlohmann::ordered_json& example) {
  const auto get = [&](const char* member) { return example.at(member).get<std::string>(); };
  std::string command = "fenestra " + quoteForShell(get("volume"));
  const auto add = [&](const char* option, const char* member) {
    if (!example.at(member).is_null())
      command += concat(option, quoteForShell(get(member)));
  };
  add(" --volume ", "choice");
  add(" --spacing ", "spacing");
  add(" --segmentation ", "segmentation");
  if (!example.at("focus").is_null())
    command += " --focus " + quoteForShell(replaceAll(get("focus"), ",", "\\,"));
  return "  " + toOneLine(command) + " --output image.png\n";
}

} // namespace fenestra::core
