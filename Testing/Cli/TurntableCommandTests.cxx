// `fenestra turntable`: its frames equal images of render, and finished frames are not rendered
// again. Also tests --view auto, which can choose the view of the first frame.

#include "CommandTesting.h"
#include "ImageTesting.h"
#include "files/images/ImageReader.h"

#include <nlohmann/json.hpp>

#include <csignal>
#include <sstream>

namespace fenestra::core::TurntableCommandTests {
namespace {

const Arguments focus = {"--segmentation", "segments.seg.nrrd", "--focus", "A"};

class TurntableCommand : public SmallScene {
protected:
  /// Arguments of `fenestra turntable volume.nrrd` with focus A: four frames of 16x16 pixels with 2
  /// samples per pixel.
  static Arguments makeArguments(const Arguments& more) {
    Arguments all = {"turntable", "volume.nrrd", "--size", "16x16", "--frames", "4"};
    all.insert(all.end(), focus.begin(), focus.end());
    if (std::find(more.begin(), more.end(), "--samples") == more.end())
      all.insert(all.end(), {"--samples", "2"});
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  Outcome runTurntable(const Arguments& more) const {
    return run(makeArguments(more), folder.path());
  }

  static std::string makeFrameName(int number) {
    return "turn_000" + std::to_string(number) + ".exr";
  }
  /// Camera options from a frame's header.
  Arguments readCamera(const std::string& file) const {
    std::istringstream words(readImage(folder / file).header.at("camera"));
    Arguments options;
    for (std::string word; words >> word;)
      options.push_back(word);
    return options;
  }
  /// Vector value of one of these options.
  Vec3 readVector(const std::string& file, const std::string& option) const {
    for (const std::string& word : readCamera(file))
      if (word.starts_with(option)) {
        std::istringstream numbers(word.substr(option.size()));
        Vec3 v;
        char comma = 0;
        numbers >> v.x() >> comma >> v.y() >> comma >> v.z();
        return v;
      }
    throw std::runtime_error(file + " has no " + option);
  }
  /// Unit vector from a frame's target to its camera.
  Vec3 readCameraDirection(const std::string& file) const {
    return (readVector(file, "--position=") - readVector(file, "--target=")).normalized();
  }
  nlohmann::json readManifest() const {
    return nlohmann::json::parse(readBytes(folder / "turn.turntable.json"));
  }
};

TEST_F(TurntableCommand, FramesEqualThoseOfRender) {
  const Outcome outcome =
      runTurntable({"--output", "turn.exr", "--output", "turn.png", "--output", "turn.nrrd",
                    "--clip-boundary", "exact", "--steady", "0", "--stats-json", "all.json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_TRUE(outcome.result.starts_with("turn_0000.exr to turn_0003.exr: 4 of 4 frames"))
      << outcome.result;
  for (int i = 0; i < 4; ++i) {
    for (const char* ending : {".png", ".nrrd", "-Z.nrrd"})
      EXPECT_TRUE(std::filesystem::exists(folder / ("turn_000" + std::to_string(i) + ending)));
    Arguments arguments = {"--output", "single.exr", "--clip-boundary", "exact"};
    for (const Arguments& more : {focus, readCamera(makeFrameName(i))})
      arguments.insert(arguments.end(), more.begin(), more.end());
    ASSERT_EQ(renderVolume(arguments).status, 0);
    const Image single = readImage(folder / "single.exr"),
                frame = readImage(folder / makeFrameName(i));
    EXPECT_EQ(single.channels, frame.channels) << i;
    EXPECT_EQ(single.header.at("camera"), frame.header.at("camera"));
  }
  EXPECT_NE(readImage(folder / makeFrameName(0)).channels,
            readImage(folder / makeFrameName(1)).channels);
  const auto stats = nlohmann::json::parse(readBytes(folder / "all.json"));
  EXPECT_EQ(stats["rendered"], 4);
  EXPECT_GT(stats["surfaceChangeMmPerDegree"]["max"], 0.0);
  EXPECT_EQ(listFiles(folder.path()).size(),
            2U + 4 * 4 + 3); // inputs, frames, single.exr, two .json
}

TEST_F(TurntableCommand, RotatesAroundTheTargetFromTheRequestedView) {
  ASSERT_EQ(
      runTurntable({"--output", "turn.exr", "--view", "anterior", "--degrees", "-180"}).status, 0);
  EXPECT_LT((readCameraDirection(makeFrameName(0)) - Vec3::UnitY()).norm(), 1e-12);
  EXPECT_LT((readCameraDirection(makeFrameName(2)) - Vec3::UnitX()).norm(), 1e-12)
      << "clockwise, to the patient's right";
  EXPECT_LT((readCameraDirection(makeFrameName(3)) - Vec3(1, -1, 0).normalized()).norm(), 1e-12);
  EXPECT_EQ(readVector(makeFrameName(0), "--target="), readVector(makeFrameName(3), "--target="));
}

TEST_F(TurntableCommand, RendersOnlyMissingFrames) {
  ASSERT_EQ(runTurntable({"--output", "turn.exr"}).status, 0);
  const Image removed = readImage(folder / makeFrameName(2));
  std::map<int, std::filesystem::file_time_type> written;
  for (const int index : {0, 1, 3})
    written[index] = std::filesystem::last_write_time(folder / makeFrameName(index));
  std::filesystem::remove(folder / makeFrameName(2));
  const Outcome outcome = runTurntable({"--output", "turn.exr", "--threads", "1"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  expectCounts(outcome.result, {4, 4, 1});
  for (const auto& [index, when] : written)
    EXPECT_EQ(std::filesystem::last_write_time(folder / makeFrameName(index)), when) << index;
  EXPECT_EQ(readImage(folder / makeFrameName(2)).channels, removed.channels);
  EXPECT_EQ(readManifest()["finished"].size(), 4U);
}

/// Without depth, a .nrrd frame is a single file.
TEST_F(TurntableCommand, ResumesAfterFramesWithoutDepth) {
  const Arguments options = {"--output", "turn.nrrd", "--layers", "color"};
  ASSERT_EQ(runTurntable(options).status, 0);
  const Outcome again = runTurntable(options);
  expectCounts(again.result, {4, 4, 0});
}

TEST_F(TurntableCommand, ResumesAfterAnInterruptionWithIdenticalFrames) {
  Arguments arguments = makeArguments({"--output", "turn.exr", "--samples", "60"});
  *std::find(arguments.begin(), arguments.end(), "16x16") = "64x64";
  Outcome stopped;
  {
    Arguments watched = arguments;
    watched.insert(watched.end(), {"--progress", "xml"});
    Process process(watched, folder.path());
    ASSERT_TRUE(process.waitForOutput("frame 2 of 4, "));
    process.send(SIGINT);
    stopped = process.wait();
    EXPECT_EQ(stopped.status, 5) << stopped.err;
  }
  const auto finished = readManifest()["finished"].size();
  expectCounts(stopped.result, {static_cast<int>(finished), 4});
  ASSERT_GE(finished, 1U);
  ASSERT_LT(finished, 4U);
  EXPECT_EQ(listFiles(folder.path()).size(), 2 + finished + 1) << "an unfinished frame remains";
  std::map<int, std::string> before;
  for (int i = 0; i < static_cast<int>(finished); ++i)
    before[i] = readBytes(folder / makeFrameName(i));

  const Outcome rest = run(arguments, folder.path());
  ASSERT_EQ(rest.status, 0) << rest.err;
  expectCounts(rest.result, {4, 4, 4 - static_cast<int>(finished)});
  for (const auto& [i, bytes] : before)
    EXPECT_EQ(readBytes(folder / makeFrameName(i)), bytes) << i;
  const nlohmann::json resumed = readManifest();
  Arguments complete = arguments;
  *std::find(complete.begin(), complete.end(), "turn.exr") = "complete.exr";
  ASSERT_EQ(run(complete, folder.path()).status, 0);
  for (int i = 0; i < 4; ++i)
    EXPECT_EQ(readImage(folder / ("complete_000" + std::to_string(i) + ".exr")).channels,
              readImage(folder / makeFrameName(i)).channels)
        << i;
  // The files themselves differ, since their headers contain the command.
  const nlohmann::json single =
      nlohmann::json::parse(readBytes(folder / "complete.turntable.json"));
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_EQ(single["finished"][i]["surfaceChange"], resumed["finished"][i]["surfaceChange"]);
}

TEST_F(TurntableCommand, RejectsFramesOfAnotherTurntable) {
  ASSERT_EQ(runTurntable({"--output", "turn.exr"}).status, 0);
  folder.write("frame_0001.png", "mine");
  folder.write("damaged.turntable.json", "{\"request\": 7}");
  expectErrors(
      {
          {"other samples", makeArguments({"--output", "turn.exr", "--samples", "3"}), 2,
           "turn.turntable.json: | --samples=2 | --samples=3"},
          {"other seed", makeArguments({"--output", "turn.exr", "--seed", "3"}), 2,
           "turn.turntable.json: | --seed=3"},
          {"foreign frame", makeArguments({"--output", "frame.png"}), 2, "frame_0001.png:"},
          {"damaged", makeArguments({"--output", "damaged.png"}), 3, "damaged.turntable.json: "},
      },
      folder.path());
  const Outcome again = runTurntable({"--output", "turn.exr", "--seed", "3", "--restart"});
  ASSERT_EQ(again.status, 0) << again.err;
  expectCounts(again.result, {4, 4, 4});
  EXPECT_EQ(readImage(folder / makeFrameName(1)).header.at("seed"), "3");

  folder.write("segments.seg.nrrd", makeSegments() + " ");
  const Outcome changed = runTurntable({"--output", "turn.exr", "--seed", "3"});
  EXPECT_EQ(changed.status, 2);
  expectErrorLine(changed.err, "turn.turntable.json: | segments.seg.nrrd");
}

TEST_F(TurntableCommand, DoesNotResumeAfterAFileOfTheSceneChanged) {
  std::filesystem::copy(kneeFolder() / "knee", folder / "knee");
  const Arguments turn = {
      "turntable", "knee/knee.mrml",    "--size",   "8x8", "--samples", "1",
      "--focus",   "PatellarCartilage", "--frames", "2",   "--output",  "knee.png"};
  ASSERT_EQ(run(turn, folder.path()).status, 0);
  ASSERT_EQ(run(turn, folder.path()).status, 0);
  for (const char* file : {"knee/knee.nrrd", "knee/knee.seg.nrrd"}) {
    const auto before = std::filesystem::last_write_time(folder / file);
    std::filesystem::last_write_time(folder / file, before + std::chrono::seconds(1));
    expectErrors({{file, turn, 2, "knee.turntable.json: | " + std::string(file)}}, folder.path());
    std::filesystem::last_write_time(folder / file, before);
  }
  EXPECT_EQ(run(turn, folder.path()).status, 0);
}

TEST_F(TurntableCommand, DoesNotResumeAfterDetachedVoxelsChanged) {
  NrrdText header;
  header.fields = "data file: voxels.raw\n";
  folder.write("volume.nhdr", header.encode(""));
  folder.write("voxels.raw", makeRamp());
  Arguments arguments = makeArguments({"--output", "turn.exr"});
  *std::find(arguments.begin(), arguments.end(), "volume.nrrd") = "volume.nhdr";
  ASSERT_EQ(run(arguments, folder.path()).status, 0);
  std::string others = makeRamp();
  std::swap(others[20], others[40]);
  const auto before = std::filesystem::last_write_time(folder / "voxels.raw");
  folder.write("voxels.raw", others);
  std::filesystem::last_write_time(folder / "voxels.raw", before);
  expectErrors({{"voxels", arguments, 2, "turn.turntable.json:"}}, folder.path());
}

TEST_F(TurntableCommand, ReadsAManifestOfTenThousandFrames) {
  Arguments arguments =
      makeArguments({"--output", "turn.png", "--samples", "1", "--progress", "xml"});
  *std::find(arguments.begin(), arguments.end(), "4") = "10000";
  const auto renderSome = [&] {
    Process process(arguments, folder.path());
    EXPECT_TRUE(process.waitForOutput("frame ([3-9]|[1-9][0-9]+) of 10000"));
    process.send(SIGINT);
    return process.wait();
  };
  ASSERT_EQ(renderSome().status, 5);
  nlohmann::json complete = readManifest();
  const nlohmann::json finished = complete["finished"].at(1);
  for (int frame = static_cast<int>(complete["finished"].size()); frame < 10000; ++frame) {
    complete["finished"].push_back(finished); // of files that do not exist
    complete["finished"].back()["frame"] = frame;
  }
  folder.write("turn.turntable.json", complete.dump(1));
  std::filesystem::remove(folder / "turn_0000.png");
  std::filesystem::remove(folder / "turn_0001.png");
  const Outcome again = renderSome();
  EXPECT_EQ(again.status, 5) << again.err;
}

TEST_F(TurntableCommand, StopsDuringTheComputationOfASurface) {
  Arguments arguments =
      makeArguments({"--output", "turn.exr", "--samples", "1", "--clip-boundary", "exact",
                     "--degrees", "90", "--stats-json", "all.json", "--progress", "xml"});
  *std::find(arguments.begin(), arguments.end(), "16x16") = "512x512"; // five surfaces per frame
  Process process(arguments, folder.path());
  ASSERT_TRUE(process.waitForOutput("frame 2 of 4"));
  const double frame = process.cpuSeconds(); // mostly spent on surfaces
  process.send(SIGINT);
  const Outcome outcome = process.wait();
  EXPECT_EQ(outcome.status, 5) << outcome.err;
  EXPECT_LT(outcome.cpuSeconds, frame / 4.0);
  expectCounts(outcome.result, {1, 4, 1});
  EXPECT_EQ(nlohmann::json::parse(readBytes(folder / "all.json"))["finished"], 1);
  EXPECT_EQ(listFiles(folder.path()).size(), 2U + 3) << "inputs, one frame, two .json";
}

TEST_F(TurntableCommand, RejectsOptionsForASingleImage) {
  folder.write("volume_0002.nrrd", readBytes(folder / "volume.nrrd"));
  expectErrors(
      {
          {"surface", makeArguments({"--surface", "a.vtp"}), 2, "--surface:"},
          {"xml", makeArguments({"--xml"}), 2, "--xml:"},
          {"missing folder", makeArguments({"--output", "nowhere/turn.png"}), 4,
           "nowhere/turn.turntable.json: | No such file"},
          {"no frames", makeArguments({"--steady", "50"}), 2, "--steady:"},
          {"unknown", makeArguments({"--framez", "3"}), 2, "--framez: | --frames?"},
          {"an input",
           {"turntable", "volume_0002.nrrd", "--output", "volume.nrrd"},
           2,
           "volume_0002.nrrd:"},
          {"an input with --restart",
           {"turntable", "volume_0002.nrrd", "--output", "volume.nrrd", "--restart"},
           2,
           "volume_0002.nrrd:"},
          {"auto without a focus", {"turntable", "volume.nrrd", "--view", "auto"}, 2, "--view:"},
      },
      folder.path());
}

TEST_F(TurntableCommand, AutomaticViewStartsWithTheViewOfRender) {
  ASSERT_EQ(runTurntable({"--output", "turn.exr", "--view", "auto"}).status, 0);
  for (const char* size : {"16x16", "48x32"}) {
    const std::string file = std::string(size) + ".exr";
    Arguments arguments = {"volume.nrrd", "--view", "auto",     "--samples", "1",
                           "--size",      size,     "--output", file};
    arguments.insert(arguments.end(), focus.begin(), focus.end());
    ASSERT_EQ(run(arguments, folder.path()).status, 0);
    EXPECT_LT((readCameraDirection(file) - readCameraDirection(makeFrameName(0))).norm(), 1e-12)
        << "depends on the size";
  }
}

TEST_F(TurntableCommand, AutomaticViewShowsKneeCartilageFromAnterior) {
  const std::string image = (folder / "auto.exr").string();
  for (const char* projection : {"orthographic", "perspective"}) {
    ASSERT_EQ(
        run({"knee/knee.mrml", "--focus", "FemoralCartilage,TibialCartilage", "--view", "auto",
             "--projection", projection, "--size", "16x16", "--samples", "1", "--output", image},
            kneeFolder().path())
            .status,
        0);
    EXPECT_GT(readCameraDirection("auto.exr").y(), std::cos(45.0 * pi / 180.0))
        << readCameraDirection("auto.exr");
    EXPECT_EQ(readVector("auto.exr", "--up="), Vec3::UnitZ());
  }
}

/// Each error names the file and the invalid member.
TEST_F(TurntableCommand, RejectsManifestMembersOfTheWrongType) {
  const std::string request = R"("version": "0.1", "arguments": ["a"], "inputs": [{"file": "b"}])";
  const std::vector<std::pair<std::string, std::string>> records = {
      {R"({"request": {"arguments": [], "inputs": []}})", R"(request: has no "version")"},
      {R"({"request": {"version": 1, "arguments": [], "inputs": []}})",
       "request.version: must be a string"},
      {R"({"request": {"version": "", "arguments": [1, "a"], "inputs": []}})",
       "request.arguments[0]: must be a string"},
      {R"({"request": {"version": "", "arguments": 2, "inputs": []}})",
       "request.arguments: must be an array"},
      {R"({"request": {"version": "", "arguments": [], "inputs": [3]}})",
       "request.inputs[0]: must be an object"},
      {R"({"request": {"version": "", "arguments": [], "inputs": [{"file": 4}]}})",
       "request.inputs[0].file: must be a string"},
      {R"({"request": {"version": "", "arguments": [], "inputs": [], "more": 5}})",
       "request: unknown key \"more\""},
      {R"({"request": [)" + request + "]}", "is not valid JSON"},
      {R"({"request": 6, "finished": []})", "request: must be an object"},
      {"[]", "must be an object"}};
  for (const auto& [text, message] : records) {
    folder.write("turn.turntable.json", text);
    expectErrors(
        {{text, makeArguments({"--output", "turn.exr"}), 3, "turn.turntable.json: " + message}},
        folder.path());
  }
}

TEST_F(TurntableCommand, ShardsRenderTheirFramesIntoOneFolder) {
  const auto render = [this](const std::string& output, const Arguments& more) {
    Arguments all = {"turntable", "volume.nrrd", "--size", "8x8",      "--samples",
                     "1",         "--frames",    "5",      "--output", output};
    all.insert(all.end(), more.begin(), more.end());
    return run(all, folder.path());
  };
  ASSERT_EQ(render("complete.exr", {}).status, 0);
  for (const char* part : {"2/3", "1/3", "3/3"}) {
    const Outcome outcome = render("part.exr", {"--shard", part});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
  }
  for (const char* frame : {"0000", "0001", "0002", "0003", "0004"})
    expectSameImage(folder / ("complete_" + std::string(frame) + ".exr"),
                    folder / ("part_" + std::string(frame) + ".exr"));
  const Outcome again = render("part.exr", {"--shard", "2/3"});
  expectCounts(again.result, {2, 2, 0});
  EXPECT_EQ(render("few.exr", {"--shard", "1/6"}).status, 2);
}

} // namespace
} // namespace fenestra::core::TurntableCommandTests
