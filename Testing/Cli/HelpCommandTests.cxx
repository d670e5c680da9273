// Help: usage, overview, topics and commands.

#include "CommandTesting.h"

#include <regex>
#include <sstream>

namespace fenestra::core::HelpCommandTests {
namespace {

class HelpCommand : public SmallScene {
protected:
  /// Standard output of a command that must succeed without any message.
  std::string print(const Arguments& arguments) const {
    const Outcome outcome = run(arguments, folder.path());
    EXPECT_EQ(outcome.status, 0) << outcome.messages;
    EXPECT_EQ(outcome.messages, "");
    return outcome.out;
  }
};

/// Long names of the options that a help text describes.
std::set<std::string> listOptions(const std::string& help) {
  std::set<std::string> names;
  static const std::regex option("\n  (?:-[a-z], |    )--([a-z-]+)");
  for (std::sregex_iterator it(help.begin(), help.end(), option), end; it != end; ++it)
    names.insert((*it)[1]);
  return names;
}

std::vector<std::string> splitLines(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);)
    lines.push_back(line);
  return lines;
}

const Arguments commandNames = {"render", "inspect", "phantom", "compare", "turntable",
                                "serve",  "merge",   "batch",   "describe"};

TEST_F(HelpCommand, NoArgumentsPrintFiveLinesOfUsage) {
  const Outcome outcome = run({}, folder.path());
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(outcome.out, "");
  const auto lines = splitLines(outcome.messages);
  EXPECT_EQ(lines.size(), 5u);
  EXPECT_NE(outcome.messages.find("Usage: "), std::string::npos);
  EXPECT_NE(outcome.messages.find("--help"), std::string::npos);
}

TEST_F(HelpCommand, OverviewFitsAScreenAndNamesWhatMattersFirst) {
  const std::string overview = print({"--help"});
  const auto lines = splitLines(overview);
  EXPECT_LE(lines.size(), 60u);
  for (const std::string& line : lines)
    EXPECT_LE(line.size(), 80u) << line;
  std::size_t place = 0;
  for (const std::string& command : commandNames) {
    const std::size_t found = overview.find("\n  " + command + " ");
    ASSERT_NE(found, std::string::npos) << command;
    EXPECT_GT(found, place) << command;
    place = found;
  }
  EXPECT_EQ(listOptions(overview),
            (std::set<std::string>{"segmentation", "focus", "preset", "view", "size", "quality",
                                   "output", "threads", "seed", "help"}));
  EXPECT_GE(std::count_if(lines.begin(), lines.end(),
                          [](const auto& line) { return line.starts_with("  fenestra "); }),
            4);
  for (const char* text : {"Exit status", "https://", "man fenestra", "--help all"})
    EXPECT_NE(overview.find(text), std::string::npos) << text;
  for (const Arguments& arguments :
       {Arguments{"-h"}, {"help"}, {"missing.nrrd", "--samples", "x", "--help"}, {"-h", "--zzz"}})
    EXPECT_EQ(print(arguments), overview);
}

TEST_F(HelpCommand, TopicsCoverAllOptionsOfRender) {
  const std::set<std::string> all = listOptions(print({"--help", "all"}));
  EXPECT_GT(all.size(), 50u);
  EXPECT_EQ(listOptions(print({"render", "--help"})), all);
  std::set<std::string> covered = {"help", "version"};
  for (const std::string group : {"input", "clip", "view", "appearance", "quality", "output"}) {
    const std::string help = print({"--help", group});
    EXPECT_EQ(print({"help", group}), help);
    EXPECT_EQ(print({"volume.nrrd", "-h", group}), help);
    const std::set<std::string> names = listOptions("\n" + help);
    EXPECT_LT(names.size(), all.size() / 2) << group;
    covered.insert(names.begin(), names.end());
    EXPECT_TRUE(names.contains(group) || group == "input" || group == "appearance") << group;
  }
  EXPECT_EQ(covered, all);
  // Slicer's own options are only in --xml and its users.
  for (const char* name : {"xml", "echo", "returnparameterfile", "processinformationaddress"})
    EXPECT_FALSE(all.contains(name)) << name;
}

TEST_F(HelpCommand, EveryCommandHasAnExample) {
  for (const std::string& command : commandNames) {
    const std::string help = print({command, "--help"});
    EXPECT_EQ(print({"help", command}), help);
    EXPECT_EQ(print({"--help", command}), help);
    EXPECT_EQ(print({command, "-h"}), help);
    EXPECT_NE(help.find("\nUsage: fenestra " + command + " "), std::string::npos) << help;
    EXPECT_NE(help.find("\nExample: fenestra "), std::string::npos) << command;
    EXPECT_NE(splitLines(help).front(), "") << command;
    for (const std::string& line : splitLines(help))
      EXPECT_LE(line.size(), 80u) << line;
  }
}

TEST_F(HelpCommand, UnknownTopicIsRejectedWithTheList) {
  expectErrors({{"misspelled", {"--help", "clpi"}, 2, "clip"},
                {"by help", {"help", "zzz"}, 2, "appearance"},
                {"by -h", {"-h", "zzz"}, 2, "--help"}},
               folder.path());
}

TEST_F(HelpCommand, NothingIsHelpAfterTwoDashes) {
  expectErrors({{"help", {"volume.nrrd", "--", "--help"}, 2, "--help"},
                {"version", {"--", "--version"}, 3, "--version"}},
               folder.path());
}

} // namespace
} // namespace fenestra::core::HelpCommandTests
