#include "program/Help.h"

#include <algorithm>

namespace fenestra {
namespace {

constexpr std::size_t page = 80, column = 30;

/// Line of a name and its explanation, in two columns.
std::string entry(std::string_view name, std::string_view text) {
  const std::string margin(column, ' ');
  std::string lines(margin, 0, 2);
  lines += name;
  if (lines.size() < column)
    lines.resize(column, ' ');
  else
    lines.append("\n").append(margin);
  for (const char c : wrapped(text, page - column)) {
    lines += c;
    lines += c == '\n' ? margin : "";
  }
  return lines + "\n";
}

} // namespace

std::string wrapped(std::string_view text, std::size_t width) {
  std::string lines;
  std::size_t used = 0;
  while (!text.empty()) {
    const std::string_view word = text.substr(0, text.find(' '));
    text.remove_prefix(std::min(word.size() + 1, text.size()));
    const bool fits = used + 1 + word.size() <= width;
    if (!lines.empty())
      lines += fits ? ' ' : '\n';
    lines += word;
    used = (fits ? used + 1 : 0) + word.size();
  }
  return lines;
}

std::string helpText(const CommandSyntax& syntax) {
  std::string usage = "Usage: fenestra " + syntax.name, names;
  for (const Positional& positional : syntax.positionals) {
    usage += " " + positional.name;
    names += entry(positional.name, positional.text);
  }
  std::string text = wrapped(syntax.summary, page) + "\n\n" + usage + " [FLAGS]\n\n" + names;
  text += entry("--help", "Print this and exit") + entry("--version", "Print the version and exit");
  std::string_view group;
  for (const Flag& flag : syntax.flags) {
    if (flag.group != group)
      text += "\n" + flag.group + ":\n";
    group = flag.group;
    text += entry("--" + flag.name + (flag.isSwitch() ? "" : " ") + flag.value, flag.help());
  }
  return text;
}

} // namespace fenestra
