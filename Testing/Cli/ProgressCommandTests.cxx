// Progress reports: where they are written, and their content.

#include "CommandTesting.h"

#include <regex>

namespace fenestra::core::ProgressCommandTests {
namespace {

class ProgressCommand : public SmallScene {
protected:
  /// Renders for half a second, which is enough for several reports.
  Outcome renderWithProgress(const Arguments& options) const {
    Arguments all = {"volume.nrrd", "--size", "32x32", "--seconds", "0.5"};
    all.insert(all.end(), options.begin(), options.end());
    return run(all, folder.path());
  }
};

std::vector<double> parseFractions(const std::string& text) {
  const std::string tag = "<filter-progress>";
  std::vector<double> result;
  for (std::size_t at = text.find(tag); at != std::string::npos; at = text.find(tag, at + 1))
    result.push_back(std::stod(text.substr(at + tag.size())));
  return result;
}

TEST_F(ProgressCommand, XmlWritesSlicerTagsToStandardOutput) {
  for (const Arguments& options : {Arguments{}, {"--noise", "0.05"}}) {
    Arguments all = {"--progress", "xml"};
    all.insert(all.end(), options.begin(), options.end());
    const Outcome outcome = renderWithProgress(all);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    EXPECT_TRUE(outcome.out.starts_with("<filter-start>\n<filter-name>fenestra</filter-name>\n"));
    EXPECT_NE(outcome.out.find("</filter-end>\n"), std::string::npos) << outcome.out;
    const std::vector<double> all_fractions = parseFractions(outcome.out);
    ASSERT_FALSE(all_fractions.empty());
    EXPECT_TRUE(std::is_sorted(all_fractions.begin(), all_fractions.end())) << outcome.out;
    EXPECT_GE(all_fractions.front(), 0.0);
    EXPECT_EQ(all_fractions.back(), 1.0);
  }
}

TEST_F(ProgressCommand, BarIsErasedFromStandardError) {
  const Outcome outcome = renderWithProgress({"--progress", "bar"});
  ASSERT_EQ(outcome.status, 0);
  EXPECT_NE(outcome.err.find(" % "), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find(" left "), std::string::npos) << outcome.err;
  EXPECT_TRUE(outcome.err.ends_with("\r\x1b[K")) << outcome.err;
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 0);
  EXPECT_TRUE(outcome.result.starts_with("volume.png: ")) << outcome.result;
  EXPECT_EQ(outcome.out, "");
  std::istringstream lines(outcome.err);
  for (std::string line; std::getline(lines, line, '\r');)
    EXPECT_LE(line.size(), 79 + std::string("\x1b[K").size()) << line;
}

/// Without options, each command shows one line that it updates and erases, then its result.
TEST_F(ProgressCommand, TerminalShowsABarThenTheResult) {
  const std::vector<std::pair<Arguments, std::string>> commands = {
      {{"volume.nrrd", "--size", "32x32", "--seconds", "0.5"}, "volume.png: "},
      {{"phantom", "knee", "--size", "60x68x24"}, "knee: "},
      {{"phantom", "foot", "--size", "60x24x30"}, "foot: "},
      {{"phantom", "fetus", "--size", "32x32x32"}, "fetus: "}};
  for (const auto& [arguments, result] : commands) {
    Process process(arguments, folder.path(), Stdout::file, Stderr::terminal);
    const Outcome outcome = process.wait();
    ASSERT_EQ(outcome.status, 0) << outcome.messages;
    EXPECT_EQ(outcome.out, "");
    const std::regex bars(R"((\r\x1b\[K\[#*\.*\] +\d+ %  [^\r\n]* left[^\r\n]*){3,}\r\x1b\[K)");
    EXPECT_TRUE(std::regex_match(outcome.err, bars)) << outcome.err;
    EXPECT_TRUE(outcome.result.starts_with(result)) << outcome.result;

    Arguments quiet = arguments;
    quiet.push_back("--quiet");
    EXPECT_EQ(Process(quiet, folder.path(), Stdout::file, Stderr::terminal).wait().messages, "");
  }
}

TEST_F(ProgressCommand, NoProgressIsWrittenWithoutATerminal) {
  for (const char* kind : {"auto", "none"}) {
    const Outcome outcome = renderWithProgress({"--progress", kind});
    ASSERT_EQ(outcome.status, 0);
    EXPECT_EQ(outcome.err, "");
    EXPECT_EQ(outcome.out, "");
    EXPECT_TRUE(outcome.result.starts_with("volume.png: ")) << outcome.result;
  }
}

} // namespace
} // namespace fenestra::core::ProgressCommandTests
