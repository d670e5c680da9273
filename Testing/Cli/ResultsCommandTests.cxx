// Output files: where they are written, which files they replace, and which inputs they record.

#include "CommandTesting.h"
#include "files/images/ImageReader.h"

#include <nlohmann/json.hpp>

#include <sys/stat.h>

namespace fenestra::core::ResultsCommandTests {
namespace {

class ResultsCommand : public SmallScene {
protected:
  Outcome runTurntable(Arguments arguments = {}) const {
    arguments.insert(arguments.begin(), {"turntable", "volume.nrrd", "--size", "8x8", "--samples",
                                         "1", "--output", "turn.png"});
    if (std::find(arguments.begin(), arguments.end(), "--frames") == arguments.end())
      arguments.insert(arguments.end(), {"--frames", "2"});
    return run(arguments, folder.path());
  }
};

TEST_F(ResultsCommand, StatsAreAllOfStandardOutput) {
  const Outcome outcome = renderVolume({"--output", "a.png", "--stats-json", "/dev/stdout"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_TRUE(nlohmann::json::parse(outcome.out).contains("samplesPerPixel"));
  struct stat status = {};
  ASSERT_EQ(::lstat("/dev/stdout", &status), 0);
  EXPECT_TRUE(S_ISLNK(status.st_mode));
}

TEST_F(ResultsCommand, SummaryIsOneLineForNamesWithControlCharacters) {
  const std::string name = "a\x1b[31m\nb";
  const auto expectOneLine = [](const Outcome& outcome) {
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(std::count(outcome.messages.begin(), outcome.messages.end(), '\n'), 1)
        << outcome.messages;
    EXPECT_EQ(outcome.messages.find('\x1b'), std::string::npos) << outcome.messages;
  };
  expectOneLine(renderVolume({"--output", name + ".png"}));
  expectOneLine(run({"phantom", "cube", "--size", "16", "--output", name}, folder.path()));
  expectOneLine(run({"turntable", "volume.nrrd", "--output", name + ".png", "--frames", "2",
                     "--size", "8x8", "--samples", "1"},
                    folder.path()));
  const Outcome echo = renderVolume({"--output", name + ".png", "--echo"});
  EXPECT_EQ(echo.out.find('\x1b'), std::string::npos) << echo.out;
}

TEST_F(ResultsCommand, FullStandardOutputIsAnOutputError) {
  for (const Arguments& arguments : std::initializer_list<Arguments>{
           {"--help"},
           {"--version"},
           {"--xml"},
           {"inspect", "volume.nrrd"},
           {"help"},
           {"describe", "man"},
           {"volume.nrrd", "--size", "8x8", "--samples", "1", "--output", "a.png", "--echo"}}) {
    const Outcome outcome = Process(arguments, folder.path(), Stdout::fullDisk).wait();
    EXPECT_EQ(outcome.status, 4) << arguments.front();
    EXPECT_TRUE(outcome.err.starts_with("fenestra: error: standard output: ")) << outcome.err;
  }
  EXPECT_EQ(readImage(folder / "a.png").width, 8);
}

TEST_F(ResultsCommand, PathsInTheHeaderAreRelativeToTheImage) {
  std::filesystem::create_directories(folder / "Doe^John_19501231/dicom");
  std::filesystem::create_directory(folder / "Doe^John_19501231/images");
  std::filesystem::rename(folder / "volume.nrrd", folder / "Doe^John_19501231/dicom/volume.nrrd");
  const std::string patient = (folder / "Doe^John_19501231").string();
  const Outcome outcome =
      run({patient + "/dicom/volume.nrrd", "--size", "8x8", "--samples=1",
           "--output=" + patient + "/images/a.exr", "--stats-json", patient + "/images/a.json"},
          folder.path());
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const std::filesystem::path images = folder / "Doe^John_19501231/images";
  EXPECT_EQ(
      readImage(images / "a.exr").header.at("command"),
      "fenestra ../dicom/volume.nrrd --size 8x8 --samples=1 --output=a.exr --stats-json a.json");
  EXPECT_EQ(nlohmann::json::parse(readBytes(images / "a.json"))["filesRead"],
            nlohmann::json::array({"../dicom/volume.nrrd"}));
  for (const char* file : {"a.exr", "a.json"})
    EXPECT_EQ(readBytes(images / file).find("Doe^John"), std::string::npos) << file;
}

TEST_F(ResultsCommand, TurntableRendersAnEmptyFrameAgain) {
  ASSERT_EQ(runTurntable().status, 0);
  const std::string complete = readBytes(folder / "turn_0000.png");
  std::filesystem::resize_file(folder / "turn_0000.png", 0);
  const Outcome again = runTurntable();
  ASSERT_EQ(again.status, 0) << again.err;
  expectCounts(again.result, {2, 2, 1});
  EXPECT_EQ(readBytes(folder / "turn_0000.png"), complete);
}

/// The frame is replaced by a longer file, a truncated file, and an unrelated file.
TEST_F(ResultsCommand, TurntableDoesNotReplaceAnEditedFrame) {
  ASSERT_EQ(runTurntable().status, 0);
  const std::string complete = readBytes(folder / "turn_0000.png");
  for (const std::string& edited :
       {complete + "edited", complete.substr(0, 50), std::string("mine")}) {
    folder.write("turn_0000.png", edited);
    const Outcome again = runTurntable();
    EXPECT_EQ(again.status, 2);
    expectErrorLine(again.err, "turn_0000.png:");
    EXPECT_EQ(readBytes(folder / "turn_0000.png"), edited);
  }
}

TEST_F(ResultsCommand, TurntableRejectsALinkInPlaceOfAFrame) {
  ASSERT_EQ(runTurntable().status, 0);
  folder.write("mine.txt", "mine");
  std::filesystem::remove(folder / "turn_0001.png");
  std::filesystem::create_symlink("mine.txt", folder / "turn_0001.png");
  EXPECT_EQ(runTurntable().status, 2);
  EXPECT_EQ(readBytes(folder / "mine.txt"), "mine");
}

/// A run that was killed after writing a frame, but before the manifest, leaves an unrecorded frame
/// with a provenance tag.
TEST_F(ResultsCommand, ResumedTurntableReplacesOnlyItsOwnUnrecordedFrames) {
  for (const std::string ending : {".png", ".exr", ".tif", ".nrrd"}) {
    const Arguments arguments = {"turntable", "volume.nrrd", "--size", "8x8",      "--samples",
                                 "1",         "--frames",    "2",      "--output", "go" + ending};
    std::filesystem::remove(folder / "go.turntable.json");
    ASSERT_EQ(run(arguments, folder.path()).status, 0);
    const std::string complete = readBytes(folder / ("go_0001" + ending));
    auto record = nlohmann::json::parse(readBytes(folder / "go.turntable.json"));
    record["finished"].erase(1);
    folder.write("go.turntable.json", record.dump());
    const Outcome again = run(arguments, folder.path());
    EXPECT_EQ(again.status, 0) << again.err;
    EXPECT_EQ(readBytes(folder / ("go_0001" + ending)), complete);

    folder.write("go.turntable.json", record.dump());
    folder.write("go_0001" + ending, "mine");
    const Outcome refused = run(arguments, folder.path());
    EXPECT_EQ(refused.status, 2) << refused.err;
    expectErrorLine(refused.err, "go_0001" + ending + ":");
    EXPECT_EQ(readBytes(folder / ("go_0001" + ending)), "mine");
  }
}

TEST_F(ResultsCommand, SecondTurntableOfTheSameFramesIsRejected) {
  {
    Process first({"turntable", "volume.nrrd", "--size", "64x64", "--samples", "20000", "--frames",
                   "2", "--output", "turn.png", "--progress", "xml"},
                  folder.path());
    ASSERT_TRUE(first.waitForOutput("<filter-progress>0\\.0*[1-9]"));
    const std::string record = readBytes(folder / "turn.turntable.json");
    for (const Arguments& arguments : {Arguments{}, {"--restart"}, {"--output", "turn.exr"}}) {
      const Outcome second = runTurntable(arguments);
      EXPECT_EQ(second.status, 2) << second.err;
      expectErrorLine(second.err, "turn.png:");
    }
    EXPECT_EQ(readBytes(folder / "turn.turntable.json"), record);
    EXPECT_EQ(run({"turntable", "volume.nrrd", "--size", "8x8", "--samples", "1", "--frames", "2",
                   "--output", "other.png"},
                  folder.path())
                  .status,
              0)
        << "frames with other names";
  } // killed
  EXPECT_EQ(runTurntable({"--restart"}).status, 0);
  for (const std::string& file : listFiles(folder.path()))
    EXPECT_FALSE(file.starts_with(".fenestra")) << file;
}

TEST_F(ResultsCommand, WarnsOfADepthFileOfAnEarlierImage) {
  ASSERT_EQ(renderVolume({"--output", "a.nrrd"}).err, "");
  const Outcome colorOnly =
      renderVolume({"--output", "a.nrrd", "--layers", "color", "--stats-json", "s"});
  EXPECT_EQ(colorOnly.status, 0);
  const std::string warning = "a-Z.nrrd: belongs to an earlier image than a.nrrd; remove it";
  EXPECT_EQ(colorOnly.err, "fenestra: warning: " + warning + "\n");
  EXPECT_EQ(nlohmann::json::parse(readBytes(folder / "s"))["warnings"],
            nlohmann::json::array({warning}));
  EXPECT_TRUE(std::filesystem::exists(folder / "a-Z.nrrd"));
  EXPECT_EQ(renderVolume({"--output", "a.nrrd"}).err, "");
}

TEST_F(ResultsCommand, RestartWarnsOfRemainingFrames) {
  ASSERT_EQ(runTurntable({"--frames", "5"}).status, 0);
  folder.write("turn_0003.png", "edited");
  const Outcome fewer = runTurntable({"--restart"});
  EXPECT_EQ(fewer.status, 0);
  EXPECT_EQ(fewer.err, "fenestra: warning: turn_0002.png to turn_0004.png: 2 files are from "
                       "the previous turntable of that name; remove them\n");
  EXPECT_EQ(runTurntable({"--restart"}).err, "");
}

TEST_F(ResultsCommand, RestartRejectsAFileThatIsNotAManifest) {
  folder.write("turn.turntable.json", "a user's notes");
  const Outcome outcome = runTurntable({"--restart"});
  EXPECT_EQ(outcome.status, 2) << outcome.err;
  EXPECT_EQ(readBytes(folder / "turn.turntable.json"), "a user's notes");
  folder.write("turn.turntable.json", // format of earlier versions
               R"({"request": {"version": "0.1", "arguments": []}, "finished": []})");
  EXPECT_EQ(runTurntable({"--restart"}).status, 0);
}

} // namespace
} // namespace fenestra::core::ResultsCommandTests
