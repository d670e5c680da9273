#include "program/ShellCommand.h"

#include "base/Text.h"
#include "io/MessageText.h"

#include <nlohmann/json.hpp>

namespace fenestra {

std::string quoteForShell(const std::string& argument) {
  const char* const plain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_@%+=:,./-";
  if (!argument.empty() && argument.find_first_not_of(plain) == std::string::npos)
    return argument;
  return concat("'", replaceAll(argument, "'", "'\\''"), "'");
}

std::string formatExample(const nlohmann::ordered_json& example) {
  const auto get = [&](const char* member) { return example.at(member).get<std::string>(); };
  const std::string command =
      concat("fenestra ", quoteForShell(get("volume")), " --segmentation ",
             quoteForShell(get("segmentation")), " --focus ",
             quoteForShell(replaceAll(get("focus"), ",", "\\,")), " --output image.png");
  return "  " + toOneLine(command) + "\n";
}

} // namespace fenestra
