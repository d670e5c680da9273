#include "base/Text.h"
#include "program/CommandLine.h"
#include "program/Commands.h"
#include "program/Describe.h"

#include <algorithm>

namespace fenestra {
namespace {

/// Values that a shell can offer for a flag or an argument.
struct Offer {
  std::vector<std::string> words; ///< of letters, digits and dashes
  bool files = false;

  bool operator==(const Offer&) const = default;
  std::string text() const { return join(words, " "); }
};

Offer offerFor(const Option& flag) {
  const ValueSpec& takes = flag.spec;
  return {takes.choices.empty() ? takes.namedValues : takes.choices,
          flag.canNameFile() || flag.placeholder == "DIR"};
}

Offer offerFor(const Positional& positional) {
  return {positional.choices, positional.choices.empty()};
}

std::string nameOf(const Command& command) {
  return command.syntax().name;
}

std::string commandNames() {
  return join(commands(), " ", nameOf);
}

/// Flags of a command, the common ones first.
std::vector<Option> allFlags(const CommandSyntax& syntax) {
  std::vector<Option> flags(commonOptions.begin(), commonOptions.end());
  std::ranges::copy(listOptions(syntax), std::back_inserter(flags));
  return flags;
}

/// Summary up to its first stop.
std::string firstClause(const std::string& summary) {
  const std::size_t end = std::min({summary.find(". "), summary.find("; "), summary.find(": ")});
  std::string clause = summary.substr(0, end);
  if (clause.ends_with('.'))
    clause.pop_back();
  return clause;
}

// ---- bash

constexpr const char* bashBegin =
    R"sh(# Completions of fenestra for bash 4, made by `fenestra describe bash`.

_fenestra() {
  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]}
  local commands='@COMMANDS@' command=render flags words files value=yes
  if [[ $word == = ]]; then # --flag=value is three words
    word=
  elif [[ $before == = ]]; then
    before=${COMP_WORDS[COMP_CWORD - 2]}
  fi
  if ((COMP_CWORD > 1)) && [[ " $commands " == *" ${COMP_WORDS[1]} "* ]]; then
    command=${COMP_WORDS[1]}
  fi
  case $command in
)sh";

constexpr const char* bashEnd = R"sh(  esac
  if [[ ! $value && $word == -* ]]; then
    words=$flags files=
  elif ((COMP_CWORD == 1)); then
    words="$commands $words"
  fi
  mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word"; [[ ! $files ]] || compgen -f -- "$word")
  [[ ! $files ]] || compopt -o filenames -o default 2>/dev/null
}
complete -F _fenestra fenestra
)sh";

/// Assignments of an offer to the script's variables.
std::string bashOffer(const Offer& offer) {
  return concat("words='", offer.text(), "' files=", offer.files ? "yes" : "");
}

/// Case of a command: all its flags, and the offer for the value of each.
std::string bashCase(const CommandSyntax& syntax) {
  std::vector<std::pair<Offer, std::string>> cases; // with the flags that have it
  const std::vector<Option> flags = allFlags(syntax);
  for (const Option& flag : flags) {
    if (flag.isSwitch())
      continue;
    const Offer offer = offerFor(flag);
    const auto known = std::ranges::find(cases, offer, &std::pair<Offer, std::string>::first);
    if (known == cases.end())
      cases.emplace_back(offer, "--" + flag.name);
    else
      known->second += " | --" + flag.name;
  }
  const auto name = [](const Option& flag) { return "--" + flag.name; };
  std::string text = concat("    ", syntax.name, ")\n      flags='", join(flags, " ", name),
                            "'\n      case $before in\n");
  for (const auto& [offer, names] : cases)
    text += concat("        ", names, ") ", bashOffer(offer), " ;;\n");
  return concat(text, "        *) ", bashOffer(offerFor(syntax.positionals.front())),
                " value= ;;\n      esac\n      ;;\n");
}

// ---- zsh

constexpr const char* zshBegin = R"sh(#compdef fenestra
# Completions of fenestra for zsh, made by `fenestra describe zsh`.

_fenestra_either() { # NAME...: one of these, or a file
  _alternative "names:name:($*)" 'files:file:_files'
}

_fenestra() {
  local command=render
  local -a commands=(
@COMMANDS@  )
  if ((CURRENT == 2)) && [[ $words[2] != -* ]]; then
    _describe -t commands command commands
    _files
    return
  fi
  if ((${commands[(I)${(b)words[2]}:*]})); then
    command=$words[2]
    shift words
    ((CURRENT--))
  fi
  case $command in
)sh";

constexpr const char* zshEnd = R"sh(  esac
}

_fenestra "$@"
)sh";

/// Text in single quotes, for zsh.
std::string zshQuoted(std::string_view text) {
  return concat("'", replaceAll(text, "'", "'\\''"), "'");
}

/// Text in which `marks` are escaped by a backslash.
std::string escaped(std::string_view text, std::string_view marks) {
  std::string result;
  for (const char c : text)
    result.append(marks.find(c) == marks.npos ? 0 : 1, '\\').push_back(c);
  return result;
}

std::string zshAction(const Offer& offer) {
  if (offer.words.empty())
    return offer.files ? "_files" : " ";
  return offer.files ? concat(" _fenestra_either ", offer.text()) : concat("(", offer.text(), ")");
}

std::string zshCase(const CommandSyntax& syntax) {
  std::string text = concat("    ", syntax.name, ")\n      _arguments");
  const auto add = [&text](const std::string& specification) {
    text += concat(" \\\n        ", zshQuoted(specification));
  };
  for (const Option& flag : allFlags(syntax)) {
    const std::string help = concat("[", escaped(flag.help(), "\\]"), "]");
    if (flag.isSwitch())
      add(concat("--", flag.name, help));
    else
      add(concat("*--", flag.name, "=", help, ":", escaped(flag.placeholder, "\\:"), ":",
                 zshAction(offerFor(flag))));
  }
  for (const Positional& positional : syntax.positionals)
    add(concat(":", positional.name, ":", zshAction(offerFor(positional))));
  return text + "\n      ;;\n";
}

// ---- fish

constexpr const char* fishBegin =
    R"sh(# Completions of fenestra for fish 3, made by `fenestra describe fish`.

function __fenestra_is -d 'True if the command is one of these; without: if it may still be named'
    set -l words (commandline -opc)
    set -l command render
    if contains -- "$words[2]" @COMMANDS@
        set command $words[2]
    end
    if set -q argv[1]
        contains -- $command $argv
    else
        not set -q words[2]
    end
end

complete -c fenestra -f
)sh";

std::string fishLine(const std::string& condition, const std::string& rest,
                     std::string_view text = "") {
  return concat("complete -c fenestra -n '__fenestra_is", condition, "'", rest,
                text.empty() ? "" : concat(" -d '", escaped(text, "\\'"), "'"), "\n");
}

std::string fishOffer(const Offer& offer) {
  return concat(offer.files ? " -F" : "",
                offer.words.empty() ? "" : concat(" -a '", offer.text(), "'"));
}

bool takes(const Command& command, const Option& flag) {
  return std::ranges::any_of(allFlags(command.syntax()),
                             [&flag](const Option& own) { return isSameOption(own, flag); });
}

/// Lines of the flags that no earlier command takes, each with all commands that take it.
std::string fishFlags(std::size_t which) {
  std::string lines;
  for (const Option& flag : allFlags(commands()[which].syntax())) {
    std::string takers;
    const auto isTaker = [&flag](const Command& command) { return takes(command, flag); };
    if (std::ranges::any_of(commands().first(which), isTaker))
      continue;
    for (const Command& command : commands())
      if (isTaker(command))
        takers += concat(" ", nameOf(command));
    const Offer offer = offerFor(flag);
    const char* const value = flag.isSwitch() ? "" : offer.files ? " -r" : " -x";
    lines += fishLine(takers, concat(" -l ", flag.name, value, fishOffer(offer)), flag.help());
  }
  return lines;
}

} // namespace

std::string bashCompletions() {
  std::string text = replaceAll(bashBegin, "@COMMANDS@", commandNames());
  for (const Command& command : commands())
    text += bashCase(command.syntax());
  return text + bashEnd;
}

std::string zshCompletions() {
  std::string names;
  std::string cases;
  for (const Command& command : commands()) {
    const CommandSyntax& syntax = command.syntax();
    names += concat("    ", zshQuoted(concat(syntax.name, ":", firstClause(syntax.summary))), "\n");
    cases += zshCase(syntax);
  }
  return replaceAll(zshBegin, "@COMMANDS@", names) + cases + zshEnd;
}

std::string fishCompletions() {
  std::string text = replaceAll(fishBegin, "@COMMANDS@", commandNames());
  for (std::size_t i = 0; i < commands().size(); ++i) {
    const CommandSyntax& syntax = commands()[i].syntax();
    text += fishLine("", " -a " + syntax.name, firstClause(syntax.summary));
    text += fishLine(" " + syntax.name, fishOffer(offerFor(syntax.positionals.front())));
    text += fishFlags(i);
  }
  return text;
}

} // namespace fenestra
