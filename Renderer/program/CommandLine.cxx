#include "program/CommandLine.h"

#include "base/Error.h"
#include "files/images/ImageFormat.h"
#include "io/MessageText.h"
#include "program/Commands.h"
#include "program/Help.h"
#include "program/Messages.h"
#include "program/RenderOptions.h"
#include "program/UsageError.h"
#include "program/about/About.h"

#include <algorithm>
#include <iostream>
#include <vector>

namespace fenestra::core {
namespace {

const Option commonTable[] = {
    {OptionNames("help", 'h'), "", "", "Print this help and exit"},
    {"version", "", "",
     "Print version, commit, compiler, instruction set, libraries and license (with --json as "
     "JSON) and exit"},
};

std::string formatHelpHint(const CommandSyntax& syntax) {
  return concat(" (see fenestra ", syntax.name, " --help)");
}

/// Options with short forms, as "-s, -o".
std::string listShortForms(const CommandSyntax& syntax) {
  std::vector<std::string> forms = {"-h"};
  for (const Option& option : listOptions(syntax))
    if (option.letter)
      forms.push_back(concat('-', option.letter));
  return join(forms, ", ");
}

/// Fix for an unknown option; empty: none is known.
std::string suggestOption(const CommandSyntax& syntax, std::string_view given) {
  const std::string_view name =
      given.substr(std::min(given.find_first_not_of('-'), given.size()), given.find('='));
  if (name == "i" || name == "input")
    return "; write the input without an option";
  std::vector<Option> options = listOptions(syntax);
  std::ranges::copy(commonOptions, std::back_inserter(options));
  const std::string bare(name.substr(0, name.find('=')));
  constexpr std::string_view sizeElsewhere[] = {"resolution", "width", "height"}; // f3d, Blender
  const bool isSize = std::ranges::find(sizeElsewhere, bare) != std::end(sizeElsewhere);
  const std::string likely = findLikelyOption(isSize ? "size" : toLower(bare), options);
  if (!likely.empty())
    return concat("; did you mean --", likely, "?");
  if (given.starts_with("--") || name.empty())
    return "";
  if (const Option* const option = findOption(options, name[0]); option && name.size() > 1)
    return option->isSwitch() ? concat("; write short options separately, as -", name[0])
                              : concat("; write -", name[0], " ", option->placeholder);
  return concat("; short options are ", listShortForms(syntax));
}

Error makeUnknownOptionError(const CommandSyntax& syntax, std::string_view given) {
  return usageError(toOneLine(std::string(given.substr(0, given.find('=')))), ": unknown option",
                    suggestOption(syntax, given), formatHelpHint(syntax));
}

Error makeExtraArgumentError(const CommandSyntax& syntax, std::string_view given) {
  const Option* const output = findOption(syntax.options, "output");
  const bool isImage = output && output->canNameFile() && findImageFormat(given);
  std::error_code failed;
  const bool isLabelMap = findOption(syntax.options, "segmentation") &&
                          (!isImage || given.ends_with(".nrrd")) &&
                          std::filesystem::is_regular_file(given, failed);
  return usageError("'", given, "': unexpected argument after ",
                    join(syntax.positionals, " and ", std::mem_fn(&Positional::name)),
                    isLabelMap ? "; to use it as the segmentation, add -s before it"
                    : isImage  ? "; to write an image, add -o before it"
                               : "; quote names that contain blanks",
                    formatHelpHint(syntax));
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
  const std::optional<OptionWord> parsed = parseOptionWord(syntax.options, word);
  if (!parsed)
    throw makeUnknownOptionError(syntax, word);
  const auto& [option, value] = *parsed;
  if (option->isSwitch() && value)
    throw usageError("--", option->name, ": takes no value; omit it");
  if (option->isSwitch())
    return values.add(option->name, "");
  const bool isMissing = value ? value->empty()
                               : words.empty() || words.front().starts_with("--") ||
                                     parseOptionWord(syntax.options, words.front());
  if (isMissing || (!value && words.front().empty()))
    throw usageError("--", option->name, ": value is ", isMissing ? "missing" : "empty",
                     "; write --", option->name, " ", option->placeholder);
  values.add(option->name, std::string(value ? *value : takeFirst(words)));
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

/// Text for `fenestra --help [TOPIC]`. `isFirst`: nothing precedes --help, so the next word must be
/// a topic.
std::string helpAfter(std::span<const std::string_view> words, bool isFirst) {
  const bool hasTopic =
      !words.empty() && (isFirst ? !words.front().starts_with('-') : isHelpTopic(words.front()));
  return hasTopic ? makeTopicHelp(words.front()) : makeOverview();
}

} // namespace

const std::span<const Option> commonOptions = commonTable;

std::string findLikelyOption(std::string_view word, std::span<const Option> options) {
  std::vector<std::string> names;
  for (const Option& option : options)
    names.insert(names.end(), {option.name, option.oneWord});
  const std::string likely = findNearest(word, names);
  return likely.empty() ? "" : findOption(options, likely)->name;
}

std::optional<OptionValues> parseCommandLine(const CommandSyntax& syntax, int argc, char** argv,
                                             int first) {
  const std::vector<std::string_view> words(argv + first, argv + argc);
  const auto end = std::ranges::find(words, "--");
  const auto help = std::find_if(
      words.begin(), end, [](std::string_view word) { return word == "--help" || word == "-h"; });
  const auto hasArgument = [&](std::string_view word) {
    return std::find(words.begin(), end, word) != end;
  };
  if (help != end) {
    allowClosedOutput();
    const bool isOverview = &syntax == &renderSyntax && first == 1;
    std::cout << (isOverview ? helpAfter({help + 1, words.end()}, help == words.begin())
                             : makeCommandHelp(syntax))
              << std::flush;
  } else if (hasArgument("--version")) {
    allowClosedOutput();
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

} // namespace fenestra::core
