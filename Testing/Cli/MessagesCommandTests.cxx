// Messages: on standard error, complete lines, more or fewer with --verbose and --quiet.

#include "CommandTesting.h"

#include <sstream>

namespace fenestra::core::MessagesCommandTests {
namespace {

std::size_t countLines(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

/// Commands that write files, each as `fenestra … MORE`.
std::vector<Arguments> listCommands() {
  return {
      {"volume.nrrd", "--size", "8x8", "--samples", "2", "--output", "a.png"},
      {"turntable", "volume.nrrd", "--frames", "2", "--size", "8x8", "--samples", "1", "--output",
       "t.png", "--restart"},
      {"batch", "t.csv", "--size", "8x8", "--samples", "1", "--restart"},
      {"phantom", "cube", "--size", "16"},
      {"merge", "part.film", "--output", "m.png"},
  };
}

class MessagesCommand : public SmallScene {
protected:
  MessagesCommand() {
    folder.write("t.csv", "name,input\nfirst,volume.nrrd\nsecond,volume.nrrd\n");
    EXPECT_EQ(run({"volume.nrrd", "--size", "8x8", "--samples", "1", "--checkpoint", "part.film",
                   "--output", "p.png"},
                  folder.path())
                  .status,
              0);
  }

  Outcome runWith(Arguments command, const Arguments& more) const {
    command.insert(command.end(), more.begin(), more.end());
    const Outcome outcome = run(command, folder.path());
    EXPECT_EQ(outcome.status, 0) << outcome.messages;
    return outcome;
  }
};

TEST_F(MessagesCommand, ByDefaultTheResultIsOneLineOnStandardError) {
  for (const Arguments& command : listCommands()) {
    const Outcome outcome = runWith(command, {});
    EXPECT_EQ(outcome.out, "") << command.front();
    EXPECT_EQ(countLines(outcome.messages), 1u) << outcome.messages;
    EXPECT_EQ(outcome.messages, outcome.result);
  }
}

TEST_F(MessagesCommand, QuietPrintsNothing) {
  for (const Arguments& command : listCommands())
    for (const char* option : {"--quiet", "-q"}) {
      const Outcome outcome = runWith(command, {option});
      EXPECT_EQ(outcome.out, "") << command.front();
      EXPECT_EQ(outcome.messages, "") << command.front();
    }
  // Long enough for a bar.
  EXPECT_EQ(
      runWith({"volume.nrrd", "--size", "32x32", "--seconds", "0.5", "-q"}, {"--progress", "bar"})
          .messages,
      "");
}

TEST_F(MessagesCommand, QuietKeepsWarningsAndErrors) {
  const Outcome outcome =
      runWith(listCommands().front(), {"--quiet", "--transfer", "ct-bone"}); // is no CT
  EXPECT_EQ(outcome.result, "");
  EXPECT_TRUE(outcome.messages.starts_with("fenestra: warning: ")) << outcome.messages;
  expectErrors({{"error", {"missing.nrrd", "--quiet"}, 3, "missing.nrrd"},
                {"both", {"volume.nrrd", "--quiet", "--verbose"}, 2, "--quiet"}},
               folder.path());
}

TEST_F(MessagesCommand, VerbosePrintsOneFactPerLine) {
  const Arguments focus = {"--segmentation", "segments.seg.nrrd", "--focus", "A", "--verbose"};
  const Outcome outcome = runWith(listCommands().front(), focus);
  EXPECT_EQ(outcome.out, "");
  EXPECT_NE(outcome.err.find("transfer function: by the volume's range\n"), std::string::npos)
      << outcome.err;
  EXPECT_NE(outcome.err.find("\ncontrast of "), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.result, "");
  const Outcome preset = runWith(listCommands().front(), {"--transfer", "mr-knee", "-v"});
  EXPECT_NE(preset.err.find("transfer function: mr-knee\n"), std::string::npos) << preset.err;
  const Outcome batch = runWith(listCommands()[2], {"--verbose"});
  EXPECT_EQ(countLines(batch.err), 2u) << batch.err; // one per row
}

TEST_F(MessagesCommand, ResultStatesNoiseAsPercentage) {
  const Outcome outcome = runWith(listCommands().front(), {"--denoise", "off"});
  EXPECT_TRUE(outcome.result.starts_with("a.png: 8x8 pixels, 2 samples per pixel, noise "))
      << outcome.result;
  EXPECT_NE(outcome.result.find(" %, "), std::string::npos) << outcome.result;
  EXPECT_TRUE(outcome.result.ends_with(" s\n")) << outcome.result;
}

/// The bar is erased before the warning, and drawn again after it.
TEST_F(MessagesCommand, BarAndLinesNeverInterleave) {
  Process process({"volume.nrrd", "--size", "64x64", "--samples", "1000000", "--seconds", "2.2",
                   "--threads", "1", "--progress", "bar", "--checkpoint", "c.film", "--output",
                   "c.exr"},
                  folder.path());
  ASSERT_TRUE(process.waitForMessage(" left"));
  std::filesystem::create_directory(folder / "c.film"); // makes writing fail
  const Outcome outcome = process.wait();
  ASSERT_EQ(outcome.status, 0) << outcome.messages;
  std::vector<std::string> lines, bars;
  std::istringstream text(outcome.messages);
  for (std::string line; std::getline(text, line);) {
    const std::string eraser = "\r\x1b[K";
    std::size_t begin = 0;
    for (std::size_t next; (next = line.find(eraser, begin)) != std::string::npos;
         begin = next + eraser.size())
      bars.push_back(line.substr(begin, next - begin));
    lines.push_back(line.substr(begin));
  }
  ASSERT_EQ(lines.size(), 2u) << outcome.messages;
  EXPECT_TRUE(lines[0].starts_with("fenestra: warning: c.film: ")) << lines[0];
  EXPECT_TRUE(lines[1].starts_with("c.exr: 64x64 pixels, ")) << lines[1];
  EXPECT_EQ(lines[1] + "\n", outcome.result);
  EXPECT_GT(bars.size(), 5u);
  for (const std::string& bar : bars)
    EXPECT_TRUE(bar.empty() || (bar.starts_with('[') && bar.find(" left") != std::string::npos))
        << bar;
}

} // namespace
} // namespace fenestra::core::MessagesCommandTests
