#include "program/CommandLine.h"

#include "base/Error.h"
#include "program/Commands.h"
#include "program/about/About.h"

#include <algorithm>
#include <iostream>
#include <vector>

namespace fenestra {
namespace {

const Flag everywhere[] = {
    {"help", "", "", "Print this and exit"},
    {"version", "", "",
     "Print version, commit, compiler, instruction set, libraries and licence, as JSON with "
     "--json, and exit"},
};

constexpr std::size_t page = 80, column = 30; ///< characters of a help line, and before its text

/// Line of a name and its explanation, in two columns.
std::string entry(std::string_view name, std::string_view text) {
  const std::string margin(column, ' ');
  std::string head = textOf("  ", name);
  if (head.size() < column)
    head.resize(column, ' ');
  else
    head.append("\n").append(margin);
  return textOf(head, replacedAll(wrapped(text, page - column), "\n", "\n" + margin), "\n");
}

/// Summary, positional arguments and flags by group.
std::string helpText(const CommandSyntax& syntax) {
  std::string usage = "Usage: fenestra " + syntax.name, names;
  for (const Positional& positional : syntax.positionals) {
    usage += " " + positional.name + (positional.repeats ? "..." : "");
    names += entry(positional.name, positional.text);
  }
  std::string text = textOf(wrapped(syntax.summary, page), "\n\n", usage, " [FLAGS]\n\n", names);
  for (const Flag& flag : commonFlags)
    text += entry("--" + flag.name, flag.text);
  std::string group;
  for (const Flag& flag : takenFlags(syntax)) {
    if (flag.group != group)
      text += "\n" + flag.group + ":\n";
    group = flag.group;
    text += entry(textOf("--", flag.name, flag.isSwitch() ? "" : " ", flag.value), flag.help());
  }
  return text;
}

std::string seeHelp(const CommandSyntax& syntax) {
  return textOf(" (fenestra ", syntax.name, " --help lists what there is)");
}

Error unknownFlag(const CommandSyntax& syntax, std::string_view given) {
  given = given.substr(0, given.find('='));
  std::vector<std::string> names = namesOf(commonFlags);
  std::ranges::copy(namesOf(takenFlags(syntax)), std::back_inserter(names));
  const std::string_view word = given.substr(std::min(given.find_first_not_of('-'), given.size()));
  const std::string likely = nearest(lower(word), names);
  return usageError(given, ": no such flag",
                    likely.empty() ? "" : textOf("; did you mean --", likely, "?"),
                    seeHelp(syntax));
}

Error extraArgument(const CommandSyntax& syntax, std::string_view given) {
  return usageError("'", given, "': one argument too many after ",
                    joined(syntax.positionals, " and ", std::mem_fn(&Positional::name)),
                    "; quote names with blanks", seeHelp(syntax));
}

using Words = std::span<const std::string_view>;

std::string_view takeFirst(Words& words) {
  const std::string_view word = words.front();
  words = words.subspan(1);
  return word;
}

/// Takes the flag `word`, and its value from the same word or the next.
void takeFlag(const CommandSyntax& syntax, std::string_view word, Words& words,
              FlagValues& values) {
  const std::size_t equals = word.find('=');
  const bool hasValue = equals != word.npos;
  const Flag* const flag =
      word.starts_with("--") ? findFlag(syntax.flags, word.substr(2, equals - 2)) : nullptr;
  if (!flag)
    throw unknownFlag(syntax, word);
  if (flag->isSwitch() && hasValue)
    throw usageError("--", flag->name, ": is a switch; write it without a value");
  if (flag->isSwitch())
    return values.add(flag->name, "");
  const bool isMissing =
      hasValue ? equals + 1 == word.size() : words.empty() || words.front().starts_with("--");
  if (isMissing || (!hasValue && words.front().empty()))
    throw usageError("--", flag->name, ": its value is ", isMissing ? "missing" : "empty",
                     "; write --", flag->name, " ", flag->value);
  values.add(flag->name, std::string(hasValue ? word.substr(equals + 1) : takeFirst(words)));
}

FlagValues parsedWords(const CommandSyntax& syntax, Words words) {
  FlagValues values(syntax.flags);
  auto positional = syntax.positionals.begin();
  for (bool flagsEnded = false; !words.empty();) {
    const std::string_view word = takeFirst(words);
    if (!flagsEnded && word == "--")
      flagsEnded = true;
    else if (!flagsEnded && word.size() > 1 && word[0] == '-')
      takeFlag(syntax, word, words, values);
    else if (positional == syntax.positionals.end())
      throw extraArgument(syntax, word);
    else if (word.empty())
      throw usageError(positional->name, ": is empty; name a file");
    else if (values.add(positional->name, std::string(word)); !positional->repeats)
      ++positional;
  }
  if (positional != syntax.positionals.end() && !values.has(positional->name))
    throw usageError(positional->name, ": is missing; name it: ", positional->text,
                     seeHelp(syntax));
  for (const Refusal& refusal : syntax.refusals)
    for (const std::string& name : refusal.names)
      if (values.has(name))
        throw usageError("--", name, ": ", refusal.why);
  return values;
}

/// Optimal string alignment distance: insertions, deletions, substitutions and swapped neighbours.
std::size_t editDistance(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i)
    for (std::size_t j = 0; j <= b.size(); ++j) {
      if (i == 0 || j == 0) {
        d[i][j] = i + j;
        continue;
      }
      d[i][j] = std::min(
          {d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0u : 1u)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[a.size()][b.size()];
}

} // namespace

const std::span<const Flag> commonFlags = everywhere;

std::vector<std::string> namesOf(std::span<const Flag> flags) {
  std::vector<std::string> names;
  std::ranges::transform(flags, std::back_inserter(names), &Flag::name);
  return names;
}

std::string nearest(std::string_view word, std::span<const std::string> candidates) {
  constexpr std::size_t longest = 32; // no name is longer, but a path may be
  std::string best;
  std::size_t least = std::min<std::size_t>(3, word.size() / 3 + 1); // more is no misspelling
  if (word.empty() || word.size() > longest)
    return best;
  for (const std::string& candidate : candidates) {
    const bool cut = word.size() >= 2 && candidate.starts_with(word);
    const std::size_t distance = cut ? 1 : editDistance(word, candidate);
    if (distance < least) {
      least = distance;
      best = candidate;
    }
  }
  return best;
}

std::optional<FlagValues> parseCommandLine(const CommandSyntax& syntax, int argc, char** argv,
                                           int first) {
  const std::vector<std::string_view> words(argv + first, argv + argc);
  const auto asksFor = [&words](std::string_view word) {
    return std::ranges::find(words, word) != words.end();
  };
  if (asksFor("--help")) {
    std::cout << helpText(syntax) << std::flush;
  } else if (asksFor("--version")) {
    useInstructions();
    std::cout << (asksFor("--json") ? aboutJson() : aboutText()) << std::flush;
  } else {
    return parsedWords(syntax, words);
  }
  return std::nullopt;
}

std::vector<Flag> takenFlags(const CommandSyntax& syntax) {
  const auto isTaken = [&](const Flag& flag) {
    return std::ranges::none_of(syntax.refusals, [&](const Refusal& refusal) {
      return std::ranges::find(refusal.names, flag.name) != refusal.names.end();
    });
  };
  std::vector<Flag> flags;
  std::ranges::copy_if(syntax.flags, std::back_inserter(flags), isTaken);
  return flags;
}

} // namespace fenestra
