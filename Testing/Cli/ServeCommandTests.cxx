// `fenestra serve`: images after changes, error events for invalid lines, and how it ends.

#include "RunSettings.h"
#include "ServeTesting.h"
#include "files/images/ImageReader.h"

#include <csignal>

namespace fenestra::core::ServeCommandTests {
namespace {

/// Limit of the processor time in seconds of an end: 2, more for slow builds. About 0.1 are needed.
const double cpuLimit = 2.0 * static_cast<double>(testing::slowdownFactor());

class ServeCommand : public ServeTest {
protected:
  static Arguments makeArguments(const std::string& size = "16x16",
                                 const std::string& samples = "4") {
    return {"serve", "volume.nrrd", "--size", size, "--samples", samples, "--output", "a.exr"};
  }

  /// Image of `fenestra volume.nrrd …` with these options.
  Image renderImage(const Arguments& options) const {
    Arguments all = {"volume.nrrd", "--size", "16x16", "--samples", "4", "--output", "b.exr"};
    all.insert(all.end(), options.begin(), options.end());
    EXPECT_EQ(run(all, folder.path()).status, 0);
    return readImage(folder / "b.exr");
  }
  /// Compares the server's latest image.
  void expectImage(const Arguments& options) const {
    EXPECT_EQ(readImage(folder / "a.exr").channels, renderImage(options).channels);
  }
};

TEST_F(ServeCommand, ImagesEqualThoseOfRender) {
  Process process(makeArguments(), folder.path());
  ASSERT_TRUE(waitForImage(process, "null")) << process.output();
  expectImage({});
  // Changes add up; null and "" remove an option. Beside each: the options of an equal render.
  const std::vector<std::pair<std::string, Arguments>> changes = {
      {R"({"id": 1, "view": "left"})", {"--view", "left"}},
      {R"({"id": 2, "seed": 3, "density": 2.5})",
       {"--view", "left", "--seed", "3", "--density-scale", "2.5"}},
      {R"({"id": 3, "view": "auto", "seed": null, "segmentation": "segments.seg.nrrd",
           "focus": ["Bone, left"]})",
       {"--view", "auto", "--density-scale", "2.5", "--segmentation", "segments.seg.nrrd",
        "--focus", "Bone\\, left"}},
      {R"({"id": 4, "view": null, "clip": "none", "density": "", "size": "8x8"})",
       {"--segmentation", "segments.seg.nrrd", "--focus", "A", "--clip", "none", "--size", "8x8"}},
      {R"({"id": 5, "size": "16x16", "environment": [1, 0.5, 0]})",
       {"--segmentation", "segments.seg.nrrd", "--focus", "A", "--clip", "none", "--environment",
        "1,0.5,0"}},
      {R"({"id": 6, "environment": null, "focus": null, "segmentation": null, "clip": null,
           "lights": "{\"lights\": [{\"type\": \"environment\", \"radiance\": [1, 2, 3]}]}"})",
       {"--lights", R"({"lights": [{"type": "environment", "radiance": [1, 2, 3]}]})"}},
  };
  for (std::size_t i = 0; i < changes.size(); ++i) {
    std::string line = changes[i].first;
    std::replace(line.begin(), line.end(), '\n', ' ');
    process.write(line + "\n");
    ASSERT_TRUE(waitForImage(process, std::to_string(i + 1))) << process.output();
    Arguments options = changes[i].second;
    // renderImage() renders 16x16 only.
    if (std::find(options.begin(), options.end(), "8x8") != options.end()) {
      EXPECT_EQ(readImage(folder / "a.exr").width, 8);
      continue;
    }
    expectImage(options);
  }
  process.closeInput();
  const Outcome outcome = process.wait();
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.err, "");
}

TEST_F(ServeCommand, HeaderHasTheCommandOfTheChangedImage) {
  Process process(makeArguments(), folder.path());
  process.write("{\"id\": 1, \"view\": \"left\", \"seed\": 5}\n");
  ASSERT_TRUE(waitForImage(process, "1")) << process.output();
  const std::string command = readImage(folder / "a.exr").header.at("command");
  EXPECT_TRUE(command.starts_with("fenestra volume.nrrd ")) << command;
  EXPECT_NE(command.find(" --seed=5"), std::string::npos) << command;
  EXPECT_NE(command.find(" --view=left"), std::string::npos) << command;
}

TEST_F(ServeCommand, ImageIsRefinedUntilTheNextChange) {
  Process process(makeArguments("256x256", "1000000"), folder.path());
  ASSERT_TRUE(process.waitForOutput("\"done\":false[^\n]*\n[^\n]*\"done\":false[^\n]*\n"));
  const std::vector<json> refined = readEvents(process);
  ASSERT_GE(refined.size(), 2u);
  EXPECT_LT(refined[0]["samples"], refined[1]["samples"]);
  EXPECT_EQ(refined[0]["files"], json::array({"a.exr"}));
  process.write(
      "{\"id\": \"left\", \"view\": \"left\"}\n{\"id\": \"up\", \"view\": \"superior\"}\n");
  ASSERT_TRUE(process.waitForOutput("\"picture\",\"id\":\"up\"")) << process.output();
  for (const json& event : readEvents(process))
    EXPECT_EQ(event["event"], "picture");
}

TEST_F(ServeCommand, InvalidLineGivesAnErrorAndChangesNothing) {
  Process process(makeArguments(), folder.path());
  ASSERT_TRUE(waitForImage(process, "null"));
  const std::vector<std::array<std::string, 3>> lines = {
      {"{\"view\"", "null", "not valid JSON"},
      {"[1, 2]", "null", "expected a JSON object"},
      {"\xff\xfe", "null", "not valid JSON"},
      {R"({"id": 1, "veiw": "left"})", "1", "veiw: unknown option; did you mean view"},
      {R"({"id": 2, "view": "top"})", "2", "--view: expected anterior"},
      {R"({"id": 2, "view": "auto"})", "2", "--view: auto requires a focus"},
      {R"({"id": 3, "view": {}})", "3", "view: expected a text"},
      {R"({"id": 4, "output": "b.png"})", "4", "output: cannot change"},
      {R"({"id": 5, "focus": "A"})", "5", "--focus: requires --segmentation"},
      {R"({"id": 6, "segmentation": "missing.nrrd", "focus": "A"})", "6", "missing.nrrd"},
      {R"({"id": 7, "segmentation": "segments.seg.nrrd", "focus": "C"})", "7", "C"},
      {R"({"id": 8, "size": "0x0"})", "8", "--size"},
      {R"({"id": 8, "annotate": "scale", "projection": "perspective"})", "8", "--annotate: scale"},
      {"{\"id\": 9, \"lights\": \"" + std::string(1 << 20, 'x') + "\"}", "null",
       "more than a million"},
      {R"({"id": 10, "samples": 1e999})", "null", "too large"},
      {"{\"id\": " + std::string(100'000, '[') + std::string(100'000, ']') + "}", "null",
       "is nested deeper than 64"},
      {R"({"id": {"a": 1}, "view": "left"})", "null", "id: must be a number, a text"},
      {R"({"id": [1], "view": "left"})", "null", "id: must be"},
      {R"({"id": true, "view": "left"})", "null", "id: must be"},
      {R"({"id": ")" + std::string(257, 'x') + R"(", "view": "left"})", "null", "id: must be"},
      {"", "", ""}, // an empty line is ignored
  };
  for (const auto& [line, id, message] : lines) {
    process.write(line + "\n");
    EXPECT_TRUE(message.empty() || waitForError(process, id, message))
        << line.substr(0, 99) << process.output();
  }
  process.write("{\"id\": 99, \"view\": \"left\"}\n");
  ASSERT_TRUE(waitForImage(process, "99")) << process.output();
  expectImage({"--view", "left"}); // without any of the rejected changes
}

/// Sends the lines in one write, so that the server reads them together.
TEST_F(ServeCommand, ChangesBeforeAndAfterARejectedOneApply) {
  Process process(makeArguments(), folder.path());
  ASSERT_TRUE(waitForImage(process, "null"));
  const std::vector<std::string> rejected = {
      R"({"id": "rejected", "lights": "/dev/zero"})",
      R"({"id": "rejected", "transfer": "missing.json"})",
      R"({"id": "rejected", "environment": "missing.exr"})",
      R"({"id": "rejected", "segmentation": "missing.nrrd", "focus": "A"})",
      R"({"id": "rejected", "segmentation": "segments.seg.nrrd", "focus": "C"})"};
  for (std::size_t i = 0; i < rejected.size(); ++i) {
    const std::string number = std::to_string(i), before = "before" + number,
                      after = "after" + number;
    process.write(R"({"id": ")" + before + R"(", "seed": )" + std::to_string(i + 1) + "}\n" +
                  rejected[i] + "\n" + R"({"id": ")" + after + R"(", "density": )" +
                  std::to_string(i + 2) + "}\n");
    ASSERT_TRUE(waitForError(process, "\"rejected\"", "")) << rejected[i] << process.output();
    ASSERT_TRUE(waitForImage(process, "\"" + after + "\"")) << rejected[i] << process.output();
    expectImage({"--seed", std::to_string(i + 1), "--density-scale", std::to_string(i + 2)});
  }
  std::size_t errors = 0;
  for (const json& event : readEvents(process)) {
    EXPECT_EQ(event["event"] == "error", event["id"] == "rejected") << event;
    errors += event["event"] == "error" ? 1 : 0;
  }
  EXPECT_EQ(errors, rejected.size());
}

TEST_F(ServeCommand, ChangedViewEndsWithTheDenoisedImageOfRender) {
  const Arguments options = {"volume.nrrd", "--size", "32x32", "--samples", "8", "--output"};
  Arguments arguments = options;
  arguments.insert(arguments.begin(), "serve");
  arguments.emplace_back("a.png");
  Process process(arguments, folder.path());
  ASSERT_TRUE(waitForImage(process, "null"));
  process.write(R"({"id": 1, "position": [5, 60, 9]})"
                "\n");
  ASSERT_TRUE(waitForImage(process, "1")) << process.output();
  for (const json& event : readEvents(process))
    EXPECT_EQ(event.value("noiseDenoised", 0.0) > 0.0, event["samples"] > 1) << event;
  Arguments render = options;
  render.insert(render.end(), {"b.png", "--position", "5,60,9"});
  ASSERT_EQ(run(render, folder.path()).status, 0);
  EXPECT_EQ(readBytes(folder / "a.png"), readBytes(folder / "b.png"));
}

TEST_F(ServeCommand, PauseEndsTheRenderAndTheNextChangeContinues) {
  Process process(makeArguments("16x16", "100000000"), folder.path());
  ASSERT_TRUE(process.waitForOutput("picture"));
  process.write(R"({"pause": false})"
                "\n"
                R"({"pause": true, "view": "left"})"
                "\n"
                R"({"pause": true})"
                "\n");
  EXPECT_TRUE(process.waitForOutput("\"error\"[^\n]*pause[^\n]*\n[^\n]*\"error\"[^\n]*pause"));
  double before = -1.0;
  EXPECT_TRUE(process.waitUntil([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    return std::exchange(before, process.cpuSeconds()) == process.cpuSeconds();
  })) << "it still renders";
  process.write("{\"id\": 2, \"samples\": 4}\n");
  ASSERT_TRUE(waitForImage(process, "2")) << process.output();
}

/// If an image cannot be written, as on a full disk, the render and the server continue.
TEST_F(ServeCommand, WriteFailureGivesAnErrorAndServingContinues) {
  const std::filesystem::path resultFolder = folder / "results";
  std::filesystem::create_directory(resultFolder);
  Process process({"serve", "volume.nrrd", "--size", "16x16", "--samples", "100000000", "--output",
                   "results/a.exr"},
                  folder.path());
  ASSERT_TRUE(process.waitForOutput("picture"));
  std::filesystem::remove_all(resultFolder);
  ASSERT_TRUE(waitForError(process, "null", "results/a.exr")) << process.output();
  std::filesystem::create_directory(resultFolder);
  process.write("{\"id\": 2, \"samples\": 4}\n");
  ASSERT_TRUE(waitForImage(process, "2")) << process.output();
}

TEST_F(ServeCommand, EndOfInputEndsWithStatus0) {
  for (const char* samples : {"1", "1000000"}) {
    Process process(makeArguments("16x16", samples), folder.path());
    ASSERT_TRUE(process.waitForOutput("picture"));
    process.closeInput();
    const Outcome outcome = process.wait();
    EXPECT_EQ(outcome.status, 0);
    EXPECT_EQ(outcome.err, "");
    EXPECT_LT(outcome.cpuSeconds, cpuLimit);
    EXPECT_EQ(listFiles(folder.path()).size(), 3u); // two inputs and the image
  }
}

TEST_F(ServeCommand, SignalEndsWithStatus5) {
  for (const int signal : {SIGINT, SIGTERM}) {
    Process process(makeArguments("16x16", "1000000"), folder.path());
    ASSERT_TRUE(process.waitForOutput("picture"));
    process.send(signal);
    const Outcome outcome = process.wait();
    EXPECT_EQ(outcome.status, 5);
    EXPECT_LT(outcome.cpuSeconds, cpuLimit);
    EXPECT_EQ(listFiles(folder.path()).size(), 3u);
  }
}

TEST_F(ServeCommand, ClosedOutputEndsWithStatus4) {
  Process process(makeArguments(), folder.path(), Stdout::closedPipe);
  const Outcome outcome = process.wait();
  EXPECT_EQ(outcome.status, 4);
  EXPECT_TRUE(outcome.err.starts_with("fenestra: ")) << outcome.err;
}

TEST_F(ServeCommand, MissingInputStatsAndSurfaceOptionsAreRejected) {
  expectErrors({{"no input", {"serve"}, 2, "INPUT:"},
                {"missing", {"serve", "missing.nrrd"}, 3, "missing.nrrd:"},
                {"stats", {"serve", "volume.nrrd", "--stats-json", "a.json"}, 2, "--stats-json:"},
                {"surface", {"serve", "volume.nrrd", "--surface", "a.vtp"}, 2, "--surface:"}},
               folder.path());
}

} // namespace
} // namespace fenestra::core::ServeCommandTests
