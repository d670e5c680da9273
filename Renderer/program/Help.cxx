#include "program/Help.h"

#include "base/Error.h"
#include "io/MessageText.h"
#include "program/CommandLine.h"
#include "program/Commands.h"
#include "program/RenderOptions.h"
#include "program/UsageError.h"
#include "program/about/Version.h"

#include <algorithm>

namespace fenestra::core {
namespace {

constexpr std::size_t pageWidth = 80,
                      textColumn = 30; ///< characters per line, and before descriptions

/// A name and its description, in two columns.
std::string formatEntry(std::string_view name, std::string_view text) {
  const std::string margin(textColumn, ' ');
  std::string head = concat("  ", name);
  if (head.size() + 2 <= textColumn)
    head.resize(textColumn, ' ');
  else
    head.append("\n").append(margin);
  return concat(head, replaceAll(wrapLines(text, pageWidth - textColumn), "\n", "\n" + margin),
                "\n");
}

/// Entry of an option: "-o, --output FILE" and `text`.
std::string formatOption(const Option& option, std::string_view text) {
  const std::string letter = option.letter ? concat('-', option.letter, ", ") : "    ";
  return formatEntry(
      concat(letter, "--", option.name, option.isSwitch() ? "" : " ", option.placeholder), text);
}

/// Entries of the options for which `isIncluded`, with a heading per group.
template <typename Predicate>
std::string formatGroups(const CommandSyntax& syntax, Predicate&& isIncluded) {
  std::string text, group;
  for (const Option& option : listOptions(syntax)) {
    if (option.group.empty() || !isIncluded(option))
      continue;
    if (option.group != group)
      text += concat("\n", option.group, ":\n");
    group = option.group;
    text += formatOption(option, option.help());
  }
  return text;
}

std::string formatCommon() {
  std::string text;
  for (const Option& option : commonOptions)
    text += formatOption(option, option.description);
  return text;
}

std::string listGroupNames() {
  return join(renderGroups, ", ", [](const OptionGroup& group) { return group.name; });
}

/// The options of render that matter first, with short descriptions.
struct FirstOption {
  const char* name;
  const char* text;
};
constexpr FirstOption firstOptions[] = {
    {"segmentation", "Segmentation: .seg.nrrd or any label map"},
    {"focus", "Segments to show unobstructed, by name"},
    {"preset", "Focus and view for one anatomy, such as liver"},
    {"view", "anterior, posterior, left, right, superior, ..."},
    {"size", "Image size in pixels [512x512]"},
    {"quality", "draft, normal, high or final"},
    {"output", "Image: .png .tif .exr .nrrd [INPUT.png]"},
    {"threads", "Number of threads [all cores]"},
    {"seed", "Seed of the random numbers [0]"},
};

constexpr const char* examples = R"(Examples:
  fenestra phantom knee                                    (writes test data)
  fenestra knee/knee.mrml --focus FemoralCartilage -o knee.png
  fenestra ct.nii.gz -s organs.nii.gz --preset liver --quality high -o liver.png
  fenestra inspect scene.mrb

Exit status: 0 done, 2 wrong usage, 3 bad input, 4 output or resource failure,
  5 stopped by a signal (what was rendered so far is written)

)";

} // namespace

std::string makeUsage() {
  return concat("fenestra: renders medical volumes, and cuts away what hides a segment\n"
                "Usage: fenestra INPUT [--focus SEGMENT] [-o IMAGE] [OPTIONS]\n"
                "       fenestra COMMAND [ARGUMENTS] [OPTIONS]\n"
                "Example: fenestra knee.mrml --focus FemoralCartilage -o knee.png\n"
                "Help: fenestra --help\n");
}

std::string makeOverview() {
  std::string text =
      "Renders medical volumes by Monte Carlo path tracing. A clipping surface uncovers\n"
      "the segments in focus.\n\n"
      "Usage: fenestra [render] INPUT [OPTIONS]\n"
      "       fenestra COMMAND [ARGUMENTS] [OPTIONS]\n\n"
      "Commands:\n";
  for (const Command& command : commands()) {
    std::string name = command.syntax().name;
    name.resize(12, ' ');
    text += concat("  ", name, command.syntax().brief, "\n");
  }
  text += "\nFirst options of render:\n";
  for (const auto& [name, description] : firstOptions) {
    Option option = *findOption(renderSyntax.options, name);
    option.placeholder.resize(std::min(option.placeholder.find('|'), option.placeholder.size()));
    text += formatOption(option, description);
  }
  text += formatOption(commonOptions.front(), "Print this help and exit");
  return concat(text, "\n", examples,
                "More: fenestra --help all, fenestra COMMAND --help, man fenestra, or\n"
                "  fenestra --help GROUP of ",
                listGroupNames(), "\nDocumentation: ", homepageText, "\n");
}

bool isHelpTopic(std::string_view topic) {
  return topic == "all" ||
         std::ranges::any_of(renderGroups,
                             [&](const OptionGroup& group) { return topic == group.name; }) ||
         std::ranges::any_of(
             commands(), [&](const Command& command) { return topic == command.syntax().name; });
}

std::string makeTopicHelp(std::string_view topic) {
  for (const Command& command : commands())
    if (topic == command.syntax().name)
      return makeCommandHelp(command.syntax());
  if (topic == "all")
    return makeCommandHelp(renderSyntax);
  for (const OptionGroup& group : renderGroups)
    if (topic == group.name) {
      const auto isIncluded = [&](const Option& option) {
        return option.group == group.heading || option.name == group.name;
      };
      return formatGroups(renderSyntax, isIncluded).substr(1); // without the first empty line
    }
  std::vector<std::string> topics = {"all"};
  for (const OptionGroup& group : renderGroups)
    topics.emplace_back(group.name);
  for (const Command& command : commands())
    topics.push_back(command.syntax().name);
  const std::string likely = findNearest(toLower(topic), topics);
  throw usageError("--help: '", toOneLine(std::string(topic)), "' is no topic",
                   likely.empty() ? "" : concat("; did you mean ", likely, "?"),
                   " (topics: ", join(topics, ", "), ")");
}

std::string makeCommandHelp(const CommandSyntax& syntax) {
  std::string usage = "Usage: fenestra " + syntax.name, names;
  for (const Positional& positional : syntax.positionals) {
    usage += " " + positional.name + (positional.canRepeat ? "..." : "");
    names += formatEntry(positional.name, positional.description);
  }
  const std::string brief = syntax.brief.empty() ? "" : concat(syntax.brief, ".\n\n");
  const std::string example =
      syntax.example.empty() ? "" : concat("Example: fenestra ", syntax.example, "\n\n");
  return concat(brief, usage, " [OPTIONS]\n\n", wrapLines(syntax.summary, pageWidth), "\n\n",
                example, names, formatCommon(),
                formatGroups(syntax, [](const Option&) { return true; }));
}

} // namespace fenestra::core
