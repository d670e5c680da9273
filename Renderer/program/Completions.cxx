#include "base/Text.h"
#include "program/CommandLine.h"
#include "program/Commands.h"
#include "program/Describe.h"

#include <algorithm>

namespace fenestra {
namespace {

/// Values that a shell can offer for a flag or an argument.
struct Candidates {
  std::vector<std::string> words; ///< of letters, digits and dashes
  bool files = false;

  bool operator==(const Candidates&) const = default;
  std::string text() const { return join(words, " "); }
};

Candidates findCandidates(const Option& option) {
  const ValueSpec& hasOption = option.spec;
  return {hasOption.choices.empty() ? hasOption.namedValues : hasOption.choices,
          option.canNameFile() || option.placeholder == "DIR"};
}

Candidates findCandidates(const Positional& positional) {
  return {positional.choices, positional.choices.empty()};
}

std::string commandName(const Command& command) {
  return command.syntax().name;
}

std::string commandNames() {
  return join(commands(), " ", commandName);
}

/// Flags of a command, the common ones first.
std::vector<Option> listAllOptions(const CommandSyntax& syntax) {
  std::vector<Option> options(commonOptions.begin(), commonOptions.end());
  std::ranges::copy(listOptions(syntax), std::back_inserter(options));
  return options;
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
std::string bashCandidates(const Candidates& candidates) {
  return concat("words='", candidates.text(), "' files=", candidates.files ? "yes" : "");
}

/// Case of a command: all its flags, and the offer for the value of each.
std::string bashCase(const CommandSyntax& syntax) {
  std::vector<std::pair<Candidates, std::string>> cases; // with the flags that have it
  const std::vector<Option> options = listAllOptions(syntax);
  for (const Option& option : options) {
    if (option.isSwitch())
      continue;
    const Candidates candidates = findCandidates(option);
    const auto known =
        std::ranges::find(cases, candidates, &std::pair<Candidates, std::string>::first);
    if (known == cases.end())
      cases.emplace_back(candidates, "--" + option.name);
    else
      known->second += " | --" + option.name;
  }
  const auto name = [](const Option& option) { return "--" + option.name; };
  std::string text = concat("    ", syntax.name, ")\n      flags='", join(options, " ", name),
                            "'\n      case $before in\n");
  for (const auto& [candidates, names] : cases)
    text += concat("        ", names, ") ", bashCandidates(candidates), " ;;\n");
  return concat(text, "        *) ", bashCandidates(findCandidates(syntax.positionals.front())),
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
std::string zshQuote(std::string_view text) {
  return concat("'", replaceAll(text, "'", "'\\''"), "'");
}

/// Text in which `marks` are escaped by a backslash.
std::string escape(std::string_view text, std::string_view marks) {
  std::string result;
  for (const char c : text)
    result.append(marks.find(c) == marks.npos ? 0 : 1, '\\').push_back(c);
  return result;
}

std::string zshAction(const Candidates& candidates) {
  if (candidates.words.empty())
    return candidates.files ? "_files" : " ";
  return candidates.files ? concat(" _fenestra_either ", candidates.text())
                          : concat("(", candidates.text(), ")");
}

std::string zshCase(const CommandSyntax& syntax) {
  std::string text = concat("    ", syntax.name, ")\n      _arguments");
  const auto add = [&text](const std::string& specification) {
    text += concat(" \\\n        ", zshQuote(specification));
  };
  for (const Option& option : listAllOptions(syntax)) {
    const std::string help = concat("[", escape(option.help(), "\\]"), "]");
    if (option.isSwitch())
      add(concat("--", option.name, help));
    else
      add(concat("*--", option.name, "=", help, ":", escape(option.placeholder, "\\:"), ":",
                 zshAction(findCandidates(option))));
  }
  for (const Positional& positional : syntax.positionals)
    add(concat(":", positional.name, ":", zshAction(findCandidates(positional))));
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
                text.empty() ? "" : concat(" -d '", escape(text, "\\'"), "'"), "\n");
}

std::string fishCandidates(const Candidates& candidates) {
  return concat(candidates.files ? " -F" : "",
                candidates.words.empty() ? "" : concat(" -a '", candidates.text(), "'"));
}

bool hasOption(const Command& command, const Option& option) {
  return std::ranges::any_of(listAllOptions(command.syntax()),
                             [&option](const Option& own) { return isSameOption(own, option); });
}

/// Lines of the flags that no earlier command takes, each with all commands that take it.
std::string fishOptions(std::size_t which) {
  std::string lines;
  for (const Option& option : listAllOptions(commands()[which].syntax())) {
    std::string accepting;
    const auto isAccepting = [&option](const Command& command) {
      return hasOption(command, option);
    };
    if (std::ranges::any_of(commands().first(which), isAccepting))
      continue;
    for (const Command& command : commands())
      if (isAccepting(command))
        accepting += concat(" ", commandName(command));
    const Candidates candidates = findCandidates(option);
    const char* const value = option.isSwitch() ? "" : candidates.files ? " -r" : " -x";
    lines += fishLine(accepting, concat(" -l ", option.name, value, fishCandidates(candidates)),
                      option.help());
  }
  return lines;
}

} // namespace

std::string makeBashCompletions() {
  std::string text = replaceAll(bashBegin, "@COMMANDS@", commandNames());
  for (const Command& command : commands())
    text += bashCase(command.syntax());
  return text + bashEnd;
}

std::string makeZshCompletions() {
  std::string names;
  std::string cases;
  for (const Command& command : commands()) {
    const CommandSyntax& syntax = command.syntax();
    names += concat("    ", zshQuote(concat(syntax.name, ":", firstClause(syntax.summary))), "\n");
    cases += zshCase(syntax);
  }
  return replaceAll(zshBegin, "@COMMANDS@", names) + cases + zshEnd;
}

std::string makeFishCompletions() {
  std::string text = replaceAll(fishBegin, "@COMMANDS@", commandNames());
  for (std::size_t i = 0; i < commands().size(); ++i) {
    const CommandSyntax& syntax = commands()[i].syntax();
    text += fishLine("", " -a " + syntax.name, firstClause(syntax.summary));
    text += fishLine(" " + syntax.name, fishCandidates(findCandidates(syntax.positionals.front())));
    text += fishOptions(i);
  }
  return text;
}

} // namespace fenestra
