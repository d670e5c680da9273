#include "program/CommandLine.h"

#include "base/Error.h"
#include "program/Commands.h"
#include "program/UsageError.h"
#include "program/about/About.h"

#include <algorithm>
#include <iostream>
#include <vector>

namespace fenestra {
namespace {

const Option commonTable[] = {
    {"help", "", "", "Print this help and exit"},
    {"version", "", "",
     "Print version, commit, compiler, instruction set, libraries and license (with --json as "
     "JSON) and exit"},
};

constexpr std::size_t pageWidth = 80,
                      textColumn = 30; ///< characters per line, and before descriptions

/// A name and its description, in two columns.
std::string formatEntry(std::string_view name, std::string_view text) {
  const std::string margin(textColumn, ' ');
  std::string head = concat("  ", name);
  if (head.size() < textColumn)
    head.resize(textColumn, ' ');
  else
    head.append("\n").append(margin);
  return concat(head, replaceAll(wrapLines(text, pageWidth - textColumn), "\n", "\n" + margin),
                "\n");
}

/// Summary, positional arguments, and options by group.
std::string formatHelp(const CommandSyntax& syntax) {
  std::string usage = "Usage: fenestra " + syntax.name, names;
  for (const Positional& positional : syntax.positionals) {
    usage += " " + positional.name + (positional.canRepeat ? "..." : "");
    names += formatEntry(positional.name, positional.description);
  }
  std::string text =
      concat(wrapLines(syntax.summary, pageWidth), "\n\n", usage, " [OPTIONS]\n\n", names);
  for (const Option& option : commonOptions)
    text += formatEntry("--" + option.name, option.description);
  std::string group;
  for (const Option& option : listOptions(syntax)) {
    if (option.group != group)
      text += "\n" + option.group + ":\n";
    group = option.group;
    text += formatEntry(concat("--", option.name, option.isSwitch() ? "" : " ", option.placeholder),
                        option.help());
  }
  return text;
}

std::string formatHelpHint(const CommandSyntax& syntax) {
  return concat(" (see fenestra ", syntax.name, " --help)");
}

Error makeUnknownOptionError(const CommandSyntax& syntax, std::string_view given) {
  given = given.substr(0, given.find('='));
  std::vector<std::string> names = listNames(commonOptions);
  std::ranges::copy(listNames(listOptions(syntax)), std::back_inserter(names));
  const std::string_view word = given.substr(std::min(given.find_first_not_of('-'), given.size()));
  const std::string likely = findNearest(toLower(word), names);
  return usageError(given, ": unknown option",
                    likely.empty() ? "" : concat("; did you mean --", likely, "?"),
                    formatHelpHint(syntax));
}

Error makeExtraArgumentError(const CommandSyntax& syntax, std::string_view given) {
  return usageError("'", given, "': unexpected argument after ",
                    join(syntax.positionals, " and ", std::mem_fn(&Positional::name)),
                    "; quote names that contain blanks", formatHelpHint(syntax));
}

using Arguments = std::span<const std::string_view>;

std::string_view takeFirst(Arguments& words) {
  const std::string_view word = words.front();
  words = words.subspan(1);
  return word;
}

/// Parses the option `word`. Its value is in the same argument or the next.
void parseOption(const CommandSyntax& syntax, std::string_view word, Arguments& words,
                 OptionValues& values) {
  const std::size_t equals = word.find('=');
  const bool hasValue = equals != word.npos;
  const Option* const option =
      word.starts_with("--") ? findOption(syntax.options, word.substr(2, equals - 2)) : nullptr;
  if (!option)
    throw makeUnknownOptionError(syntax, word);
  if (option->isSwitch() && hasValue)
    throw usageError("--", option->name, ": takes no value; omit it");
  if (option->isSwitch())
    return values.add(option->name, "");
  const bool isMissing =
      hasValue ? equals + 1 == word.size() : words.empty() || words.front().starts_with("--");
  if (isMissing || (!hasValue && words.front().empty()))
    throw usageError("--", option->name, ": value is ", isMissing ? "missing" : "empty",
                     "; write --", option->name, " ", option->placeholder);
  values.add(option->name, std::string(hasValue ? word.substr(equals + 1) : takeFirst(words)));
}

OptionValues parseArguments(const CommandSyntax& syntax, Arguments words) {
  OptionValues values(syntax.options);
  auto positional = syntax.positionals.begin();
  for (bool optionsEnded = false; !words.empty();) {
    const std::string_view word = takeFirst(words);
    if (!optionsEnded && word == "--")
      optionsEnded = true;
    else if (!optionsEnded && word.size() > 1 && word[0] == '-')
      parseOption(syntax, word, words, values);
    else if (positional == syntax.positionals.end())
      throw makeExtraArgumentError(syntax, word);
    else if (word.empty())
      throw usageError(positional->name, ": must not be empty; name a file");
    else if (values.add(positional->name, std::string(word)); !positional->canRepeat)
      ++positional;
  }
  if (positional != syntax.positionals.end() && !values.has(positional->name))
    throw usageError(positional->name, ": missing; expected: ", positional->description,
                     formatHelpHint(syntax));
  for (const ExcludedOptions& refusal : syntax.excluded)
    for (const std::string& name : refusal.names)
      if (values.has(name))
        throw usageError("--", name, ": ", refusal.reason);
  return values;
}

/// Optimal string alignment distance: insertions, deletions, substitutions, adjacent swaps.
std::size_t computeEditDistance(std::string_view a, std::string_view b) {
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

const std::span<const Option> commonOptions = commonTable;

std::vector<std::string> listNames(std::span<const Option> options) {
  std::vector<std::string> names;
  std::ranges::transform(options, std::back_inserter(names), &Option::name);
  return names;
}

std::string findNearest(std::string_view word, std::span<const std::string> candidates) {
  constexpr std::size_t longest = 32; // option names are shorter; a path may not be
  std::string best;
  std::size_t least =
      std::min<std::size_t>(3, word.size() / 3 + 1); // a likely misspelling has fewer edits
  if (word.empty() || word.size() > longest)
    return best;
  for (const std::string& candidate : candidates) {
    const bool isPrefix = word.size() >= 2 && candidate.starts_with(word);
    const std::size_t distance = isPrefix ? 1 : computeEditDistance(word, candidate);
    if (distance < least) {
      least = distance;
      best = candidate;
    }
  }
  return best;
}

std::optional<OptionValues> parseCommandLine(const CommandSyntax& syntax, int argc, char** argv,
                                             int first) {
  const std::vector<std::string_view> words(argv + first, argv + argc);
  const auto hasArgument = [&words](std::string_view word) {
    return std::ranges::find(words, word) != words.end();
  };
  if (hasArgument("--help")) {
    std::cout << formatHelp(syntax) << std::flush;
  } else if (hasArgument("--version")) {
    pinInstructions();
    std::cout << (hasArgument("--json") ? aboutJson() : aboutText()) << std::flush;
  } else {
    return parseArguments(syntax, words);
  }
  return std::nullopt;
}

std::vector<Option> listOptions(const CommandSyntax& syntax) {
  const auto isAccepted = [&](const Option& option) {
    return std::ranges::none_of(syntax.excluded, [&](const ExcludedOptions& refusal) {
      return std::ranges::find(refusal.names, option.name) != refusal.names.end();
    });
  };
  std::vector<Option> options;
  std::ranges::copy_if(syntax.options, std::back_inserter(options), isAccepted);
  return options;
}

} // namespace fenestra
