// `fenestra batch`: failed rows do not affect others, and finished rows are not rendered again.

#include "CommandTesting.h"
#include "files/images/ImageReader.h"

#include <nlohmann/json.hpp>

#include <csignal>
#include <sstream>

namespace fenestra::core::BatchCommandTests {
namespace {

const Arguments quick = {"--size", "16x16", "--samples", "2"};

class BatchCommand : public SmallScene {
protected:
  static Arguments makeArguments(const Arguments& more, const std::string& table = "t.csv") {
    Arguments all = {"batch", table, "--output", "out"};
    all.insert(all.end(), quick.begin(), quick.end());
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  Outcome runBatch(const Arguments& more = {}) const {
    return run(makeArguments(more), folder.path());
  }
  std::string readOutput(const std::string& file) const {
    return readBytes(folder / ("out/" + file));
  }
  nlohmann::json readManifest(const std::string& row) const {
    return nlohmann::json::parse(readOutput(row + "/" + row + ".study.json"));
  }
  /// Line of a row in study.csv; empty if it is missing.
  std::string findSummary(const std::string& row) const {
    std::istringstream lines(readOutput("study.csv"));
    for (std::string line; std::getline(lines, line);)
      if (line.starts_with(row + ","))
        return line;
    return "";
  }
};

TEST_F(BatchCommand, RowsEqualThoseOfRender) {
  folder.write("t.csv", "\xef\xbb\xbfname,input,segmentation,focus,view,samples\r\n"
                        "left,volume.nrrd,segments.seg.nrrd,A,left,\r\n"
                        "\"Bone, left\",volume.nrrd,segments.seg.nrrd,\"Bone\\, left\",,3\r\n"
                        ",,,,,\r\n");
  const Outcome outcome =
      runBatch({"--formats", "exr", "--workers", "2", "--threads", "2", "--progress", "none"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_TRUE(outcome.result.starts_with("out: ")) << outcome.result;
  expectCounts(outcome.result, {2, 2, 2});
  const std::vector<std::pair<std::string, Arguments>> rows = {
      {"left", {"--focus", "A", "--view", "left"}},
      {"Bone, left", {"--focus", "A", "--samples", "3"}}};
  for (const auto& [name, options] : rows) {
    Arguments single = {"volume.nrrd", "--segmentation", "segments.seg.nrrd", "--size",    "16x16",
                        "--output",    "single.exr",     "--output",          "single.png"};
    if (name == "left")
      single.insert(single.end(), {"--samples", "2"});
    single.insert(single.end(), options.begin(), options.end());
    ASSERT_EQ(run(single, folder.path()).status, 0);
    const std::string base = "out/" + name + "/" + name;
    EXPECT_EQ(readImage(folder / (base + ".exr")).channels,
              readImage(folder / "single.exr").channels)
        << name;
    EXPECT_EQ(readBytes(folder / (base + ".png")), readBytes(folder / "single.png")) << name;
  }
  EXPECT_EQ(readImage(folder / "out/left/left.exr").header.at("command").find(folder.path()),
            std::string::npos)
      << "paths in the header are relative";
  EXPECT_NE(findSummary("\"Bone, left\"").find("done,0,,\"Bone, left/Bone, left.png\","),
            std::string::npos);
  EXPECT_GT(readImage(folder / "out/study.png").width, 16);
  EXPECT_EQ(listFiles(folder / "out").size(), 2U + 2 * (1 + 4)) << "folder and four files per row";
}

TEST_F(BatchCommand, FailedRowsDoNotAffectOthers) {
  folder.write("torn.nrrd", NrrdText().encode("x"));
  folder.write("t.csv", "name,input,focus\na,torn.nrrd,\nb,nowhere.nrrd,\nc,volume.nrrd,7\n"
                        "d,volume.nrrd,\n");
  const Outcome outcome = runBatch();
  EXPECT_EQ(outcome.status, 3) << outcome.err;
  expectStated(outcome.err, "t.csv: | a: torn.nrrd: ");
  expectCounts(outcome.err.substr(std::min(outcome.err.size(), outcome.err.find("t.csv: "))),
               {3, 4});
  expectCounts(outcome.result, {1, 4, 4});
  EXPECT_TRUE(findSummary("a").starts_with("a,failed,3,")) << findSummary("a");
  EXPECT_TRUE(findSummary("b").starts_with("b,failed,3,")) << findSummary("b");
  EXPECT_TRUE(findSummary("c").starts_with("c,failed,2,")) << findSummary("c");
  EXPECT_TRUE(findSummary("d").starts_with("d,done,0,,d/d.png,")) << findSummary("d");
  EXPECT_EQ(readManifest("b")["finished"][0]["status"], 3);
  expectStated(readManifest("b")["finished"][0]["error"], "nowhere.nrrd: ");

  folder.write("torn.nrrd", NrrdText().encode(makeRamp()));
  folder.write("nowhere.nrrd", NrrdText().encode(makeRamp()));
  const Outcome again = runBatch();
  expectCounts(again.result, {3, 4, 3});
}

TEST_F(BatchCommand, RendersOnlyRowsWhoseOptionsOrFilesChanged) {
  folder.write("other.nrrd", NrrdText().encode(makeRamp()));
  NrrdText header;
  header.fields = "data file: voxels.raw\n";
  folder.write("detached.nhdr", header.encode(""));
  folder.write("voxels.raw", makeRamp());
  const std::string rows = "name,input,seed\na,volume.nrrd,\nb,other.nrrd,\nc,detached.nhdr,";
  folder.write("t.csv", rows + "\n");
  ASSERT_EQ(runBatch().status, 0);
  const auto expectRendered = [&](int count, const Arguments& more = {}) {
    const Outcome outcome = runBatch(more);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    expectCounts(outcome.result, {3, 3, count});
  };
  expectRendered(0, {"--workers", "3", "--threads", "1"});
  folder.write("t.csv", rows + "7\n");
  expectRendered(1);
  for (const char* input : {"other.nrrd", "voxels.raw"}) {
    const auto before = std::filesystem::last_write_time(folder / input);
    std::filesystem::last_write_time(folder / input, before + std::chrono::seconds(1));
    expectRendered(1);
  }
  std::filesystem::remove(folder / "out/a/a.png");
  expectRendered(1);
  expectRendered(3, {"--exposure", "1"});
  expectRendered(3, {"--exposure", "1", "--restart"});
  expectRendered(0, {"--exposure", "1"});
}

TEST_F(BatchCommand, ResumesAfterAKillWithTheSameFiles) {
  std::string table = "name,input,samples\n";
  for (char row = 'a'; row < 'g'; ++row) // the last takes longer, so that the kill is earlier
    table += std::string(1, row) + ",volume.nrrd," + (row == 'f' ? "10000" : "2") + "\n";
  folder.write("t.csv", table);
  const Arguments arguments = makeArguments({"--workers", "2", "--verbose"});
  std::string output;
  {
    Process process(arguments, folder.path());
    ASSERT_TRUE(process.waitForMessage("b: [0-9.e-]+ s"));
    process.send(SIGKILL);
    process.wait();
    output = process.messages();
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "out/study.csv"));
  std::map<std::string, std::string> before; // statistics of the finished rows
  for (char row = 'a'; row < 'g'; ++row)
    if (output.find(std::string(1, row) + ": ") != std::string::npos)
      before[std::string(1, row)] = readOutput(std::string(1, row) + "/" + row + ".json");
  const Outcome rest = run(arguments, folder.path());
  ASSERT_EQ(rest.status, 0) << rest.err;
  expectCounts(rest.result, {6, 6});
  EXPECT_FALSE(before.empty());
  for (const auto& [row, stats] : before)
    EXPECT_EQ(readOutput(row + "/" + row + ".json"), stats) << "a finished row was rendered again";
  EXPECT_EQ(listFiles(folder / "out").size(), 2U + 6 * (1 + 3)) << "unexpected files remain";
}

TEST_F(BatchCommand, ALongRowResumesFromItsCheckpoint) {
  namespace fs = std::filesystem;
  folder.write("t.csv", "name,input,size\na,volume.nrrd,96x96\n");
  const auto arguments = [](const std::string& output, const std::string& samples) {
    return Arguments{"batch", "t.csv",     "--output", output,      "--formats",
                     "exr",   "--samples", samples,    "--threads", "1"};
  };
  {
    Process process(arguments("out", "300"), folder.path());
    ASSERT_TRUE(process.waitUntil([&] { return fs::exists(folder / "out/a/a.film"); }));
    process.send(SIGKILL);
    process.wait();
  }
  ASSERT_FALSE(fs::exists(folder / "out/a/a.png"));
  fs::copy(folder / "out", folder / "other", fs::copy_options::recursive);
  const auto countResumedPaths = [&](const std::string& output, const std::string& samples) {
    const Outcome outcome = run(arguments(output, samples), folder.path());
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    expectCounts(outcome.result, {1, 1, 1});
    EXPECT_EQ(listFiles(folder / output / "a").size(), 4U) << "unexpected files remain";
    return nlohmann::json::parse(readBytes(folder / output / "a/a.json")).value("pathsFromFilm", 0);
  };
  EXPECT_GT(countResumedPaths("out", "300"), 0);
  ASSERT_EQ(run({"volume.nrrd", "--size", "96x96", "--samples", "300", "--output", "alone.exr"},
                folder.path())
                .status,
            0);
  EXPECT_EQ(readImage(folder / "out/a/a.exr").channels, readImage(folder / "alone.exr").channels);
  EXPECT_EQ(countResumedPaths("other", "1"), 0) << "a checkpoint with other options was used";
}

TEST_F(BatchCommand, ARowWithAnUnusableCheckpointStartsOver) {
  folder.write("late.nrrd", NrrdText().encode("x"));
  folder.write("t.csv", "name,input\na,late.nrrd\n");
  EXPECT_EQ(runBatch().status, 3);
  folder.write("late.nrrd", NrrdText().encode(makeRamp()));
  folder.write("out/a/a.film", "torn");
  const Outcome again = runBatch();
  EXPECT_EQ(again.status, 0) << again.err;
  EXPECT_FALSE(std::filesystem::exists(folder / "out/a/a.film"));
  std::filesystem::remove(folder / "out/a/a.study.json");
  for (const char* file : {"a.png", "a.json"})
    std::filesystem::remove(folder / ("out/a/" + std::string(file)));
  folder.write("out/a/a.film", "mine");
  expectStated(runBatch().err, "a.film: | a.study.json");
  EXPECT_EQ(readOutput("a/a.film"), "mine");
}

TEST_F(BatchCommand, StopsOnRequestAndReportsTheRows) {
  folder.write("t.csv", "name,input,samples,size\na,volume.nrrd,2,16x16\n"
                        "b,volume.nrrd,1000000,64x64\nc,volume.nrrd,2,16x16\n");
  // When the row's process starts, and while it renders.
  for (const char* file : {"out/b/b.study.json", "out/b/b.film"}) {
    Process process({"batch", "t.csv", "--output", "out", "--restart", "-v"}, folder.path());
    ASSERT_TRUE(process.waitForMessage("a: "));
    ASSERT_TRUE(process.waitUntil([&] { return std::filesystem::exists(folder / file); }));
    process.send(SIGTERM);
    const Outcome outcome = process.wait();
    EXPECT_EQ(outcome.status, 5) << outcome.err;
    expectCounts(outcome.result, {1, 3});
    EXPECT_TRUE(findSummary("b").starts_with("b,stopped,5,,,")) << findSummary("b");
    EXPECT_TRUE(findSummary("c").starts_with("c,missing,,")) << findSummary("c");
  }
}

TEST_F(BatchCommand, SubsetsOfRowsAreCompletedByTheFullCommand) {
  folder.write("t.csv", "name,input\na,volume.nrrd\nb,volume.nrrd\nc,volume.nrrd\n");
  for (const char* part : {"1/2", "2/2"})
    ASSERT_EQ(runBatch({"--rows", part}).status, 0);
  EXPECT_FALSE(std::filesystem::exists(folder / "out/study.csv"));
  const Outcome complete = runBatch();
  expectCounts(complete.result, {3, 3, 0});
  EXPECT_TRUE(std::filesystem::exists(folder / "out/study.png"));
}

TEST_F(BatchCommand, LeavesForeignFilesUnchanged) {
  folder.write("t.csv", "name,input\na,volume.nrrd\nb,volume.nrrd\n");
  std::filesystem::create_directories(folder / "out/a");
  folder.write("out/a/a.png", "mine");
  const Outcome refused = runBatch();
  EXPECT_EQ(refused.status, 2);
  expectStated(refused.err, "out/a/a.png: | a.study.json");
  EXPECT_EQ(readOutput("a/a.png"), "mine");
  ASSERT_EQ(runBatch({"--restart"}).status, 0);
  folder.write("out/b/b.png", "mine");
  folder.write("out/a/a.study.json", "{\"request\": 7}");
  const Outcome edited = runBatch();
  expectStated(edited.err, "out/b/b.png: ");
  expectStated(edited.err, "out/a/a.study.json: request: ");
  EXPECT_EQ(readOutput("b/b.png"), "mine");
  std::filesystem::remove(folder / "out/a/a.study.json");
  ASSERT_EQ(runBatch({"--restart"}).status, 0);
  folder.write("out/study.csv", "mine");
  EXPECT_EQ(runBatch().status, 2);
  EXPECT_EQ(readOutput("study.csv"), "mine");
}

TEST_F(BatchCommand, RejectsInvalidTables) {
  const std::vector<std::array<std::string, 2>> tables = {
      {"", ""},
      {"name,input\n", ""},
      {"name\na\n", "line 1: | 'input'"},
      {"input\na\n", "line 1: | 'name'"},
      {"name,input,veiw\na,b,c\n", "line 1: | 'veiw' | view?"},
      {"name,input,stats\na,b,c\n", "line 1: | 'stats'"},
      {"name,input,view,view\na,b,,\n", "line 1: | 'view'"},
      {"name,input\na\n", "line 2: | 1 | 2"},
      {"name,input\n../a,b\n", "line 2: | '../a'"},
      {"name,input\n.a,b\n", "line 2: | '.a'"},
      {"name,input\n=1+2,b\n", "line 2: | '=1+2'"},
      {"name,input\n\"a\nb\",b\n", "line 2, name:"},
      {"name,input\n,b\n", "line 2: | ''"},
      {"name,input\na,\n", "line 2: | input"},
      {"name,input\na,b\nA,b\n", "line 3: | line 2 | 'A'"},
      {"name,input\na,\"b\n", "line 2:"},
      {"name,input\n" + std::string(101, 'a') + ",b\n", "line 2: | " + std::string(60, 'a')}};
  for (const auto& [text, place] : tables) {
    folder.write("t.csv", text);
    expectErrors({{text, makeArguments({}), 3, "t.csv: " + place}}, folder.path());
  }
  folder.write("t.csv", "name,input\na,volume.nrrd\n");
  expectErrors({{"rows", makeArguments({"--rows", "3/2"}), 2, "--rows:"},
                {"formats", makeArguments({"--formats", "gif"}), 2, "--formats:"},
                {"option", makeArguments({"--surface", "a.vtp"}), 2, "--surface:"},
                {"no table; old name", {"study", "none.csv"}, 3, "none.csv:"}},
               folder.path());
}

} // namespace
} // namespace fenestra::core::BatchCommandTests
