#include "base/Text.h"
#include "program/CommandLine.h"
#include "program/Commands.h"
#include "program/Describe.h"
#include "program/about/Commit.h"
#include "program/about/Version.h"

#include <algorithm>
#include <array>

namespace fenestra::core {
namespace {

/// "November 26, 2026" from "2026-11-26".
std::string formatDate(const std::string& date) {
  constexpr std::array months = {"January",   "February", "March",    "April",
                                 "May",       "June",     "July",     "August",
                                 "September", "October",  "November", "December"};
  const std::vector<std::string> parts = split(date, '-');
  const auto number = [&parts](std::size_t i) {
    return parseNumber<std::size_t>(parts.at(i)).value();
  };
  return concat(months.at(number(1) - 1), " ", number(2), ", ", parts[0]);
}

/// Escapes text for mdoc: option dashes stay dashes, sentences begin lines, no line is a macro.
std::string formatProse(std::string_view text) {
  constexpr std::size_t width = 76;
  const std::string plain = replaceAll(replaceAll(text, "\\", "\\e"), "--", "\\-\\-");
  std::string lines;
  for (const std::string& sentence : split(replaceAll(plain, ". ", ".\n"), '\n'))
    for (const std::string& line : split(wrapLines(sentence, width), '\n'))
      lines += concat(line.starts_with('.') || line.starts_with('\'') ? "\\&" : "", line, "\n");
  return lines;
}

std::string formatArguments(const CommandSyntax& syntax) {
  std::string text;
  for (const Positional& positional : syntax.positionals)
    text += " Ar " + positional.name;
  return text;
}

bool isRenderOption(const Option& option) {
  const Option* const other = findOption(commands().front().syntax().options, option.name);
  return other && isSameOption(*other, option);
}

std::string formatCommand(const CommandSyntax& syntax, bool isRender) {
  std::string text = concat(".It Nm Cm ", syntax.name, formatArguments(syntax), " Op Ar OPTIONS\n",
                            formatProse(syntax.summary));
  if (isRender || !std::ranges::equal(syntax.positionals, commands().front().syntax().positionals,
                                      {}, &Positional::description, &Positional::description))
    for (const Positional& positional : syntax.positionals)
      text += concat(".Pp\n.Ar ", positional.name, " :\n", formatProse(positional.description));
  return text;
}

std::string formatOption(const Option& option) {
  return concat(".It ", option.letter ? concat("Fl ", option.letter, " , ") : "", "Fl Fl ",
                option.name, option.isSwitch() ? "" : " Ar ", option.placeholder, "\n",
                formatProse(option.help()));
}

constexpr const char* listBegin = ".Bl -tag -width Ds\n";
constexpr const char* listEnd = ".El\n";

/// Options of a command by group, without those that render describes already.
std::string formatOptionLists(const CommandSyntax& syntax, bool isRender) {
  std::string text;
  std::string_view group;
  for (const Option& option : syntax.options) {
    if (option.group.empty() || (!isRender && isRenderOption(option)))
      continue;
    if (option.group != group)
      text += concat(group.empty() ? "" : listEnd, ".Ss ", syntax.name,
                     isRender ? ": " + option.group : "", "\n", listBegin);
    group = option.group;
    text += formatOption(option);
  }
  return text + (group.empty() ? "" : listEnd);
}

constexpr const char* optionNames = R"man(The value of an option follows it, or an equals sign:
.Ql \-\-size 800x600 ,
.Ql \-\-size=800x600 .
Names may be written without inner dashes, as in scenes of 3D Slicer:
.Ql \-\-labelsmoothing .
)man";

constexpr const char* rest = R"man(.Sh ENVIRONMENT
.Bl -tag -width Ds
.It Ev FENESTRA_INSTRUCTIONS
Instruction set to use, instead of the best that the machine supports;
.Nm Fl Fl version Fl Fl json
lists them.
.It Ev SLICER_HOME
Folder of 3D Slicer, whose volume property presets are then available to
.Fl Fl transfer
by name.
.El
.Sh EXIT STATUS
.Bl -tag -width Ds -compact
.It 0
Done.
.It 2
Wrong usage.
.It 3
Bad input.
.It 4
Output cannot be written, or not enough memory or threads.
.It 5
Stopped by a signal: the samples rendered so far are saved.
.El
.Sh EXAMPLES
Create a synthetic knee and render its cartilage unoccluded:
.Bd -literal -offset indent
fenestra phantom knee
fenestra knee/knee.mrml \-\-focus FemoralCartilage \-o knee.png
.Ed
.Pp
List what a scene contains and what a render of it would use:
.Bd -literal -offset indent
fenestra inspect scene.mrb
.Ed
)man";

} // namespace

std::string makeManPage() {
  std::string synopsis, entries, lists;
  for (const Command& command : commands()) {
    const CommandSyntax& syntax = command.syntax();
    const bool isFirst = &command == &commands().front();
    synopsis += concat(".Nm\n", isFirst ? ".Op Cm " : ".Cm ", syntax.name, "\n.", //
                       formatArguments(syntax).substr(1), "\n.Op Ar OPTIONS\n");
    entries += formatCommand(syntax, isFirst);
    lists += formatOptionLists(syntax, isFirst);
  }
  std::string common;
  for (const Option& option : commonOptions)
    common += formatOption(option);
  return concat(".\\\" Generated by fenestra describe man.\n.Dd ", formatDate(commitDate),
                "\n.Dt FENESTRA 1\n.Os\n.Sh NAME\n.Nm fenestra\n.Nd ", descriptionText,
                "\n.Sh SYNOPSIS\n", synopsis, ".Sh DESCRIPTION\n", listBegin, entries, listEnd,
                ".Sh OPTIONS\n", optionNames, "Every command accepts:\n", listBegin, common,
                listEnd, lists, rest, ".Sh SEE ALSO\n.Lk ", homepageText, "\n");
}

} // namespace fenestra::core
