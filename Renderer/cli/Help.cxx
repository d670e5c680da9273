#include "cli/CommandLine.h"

namespace fenestra {
namespace {

constexpr std::size_t pageWidth = 80;
constexpr std::size_t textColumn = 30;

/// Words of `text` in lines of the page, from `column` on; the first line stands there already.
std::string wrapped(std::string_view text, std::size_t column) {
  std::string lines;
  std::size_t at = column;
  while (!text.empty()) {
    const std::string_view word = text.substr(0, text.find(' '));
    text.remove_prefix(std::min(word.size() + 1, text.size()));
    if (at > column && at + 1 + word.size() > pageWidth) {
      lines += '\n' + std::string(column, ' ');
      at = column;
    }
    if (at > column)
      lines += ' ';
    at += word.size() + (at > column ? 1 : 0);
    lines += word;
  }
  return lines + '\n';
}

std::string entry(const std::string& what, const char* text) {
  std::string line = "  " + what;
  line += line.size() + 2 > textColumn ? '\n' + std::string(textColumn, ' ')
                                       : std::string(textColumn - line.size(), ' ');
  return line + wrapped(text, textColumn);
}

} // namespace

std::string helpText(const CommandSyntax& syntax) {
  std::string text = std::string("usage: fenestra ") + syntax.name;
  for (const Positional& positional : syntax.positionals)
    text += std::string(" ") + positional.name;
  text += " [flags]\n" + wrapped(syntax.summary, 0) + '\n';
  for (const Positional& positional : syntax.positionals)
    text += entry(positional.name, positional.text);
  std::string group;
  for (const Flag& flag : syntax.flags) {
    if (flag.group != group)
      text += '\n' + (group = flag.group) + ":\n";
    text += entry(std::string("--") + flag.name + " " + flag.value, flag.text);
  }
  text += '\n' + entry("--help", "Print this and exit") +
          entry("--version", "Print the version and exit");
  return text;
}

} // namespace fenestra
