// --volume-smoothing: one request shows one medium, and its results say which.

#include "CommandTesting.h"
#include "ImageTesting.h"

#include <nlohmann/json.hpp>

#include <random>

namespace fenestra::core::SmoothingCommandTests {
namespace {

/// Folder with a noisy CT of a box in air, and its values as those of an MR.
class SmoothingCommand : public ::testing::Test {
protected:
  SmoothingCommand() {
    std::mt19937 random(1);
    std::string noisy, clean, mr;
    for (int i = 0; i < edge * edge * edge; ++i) {
      const auto isInside = [](int x) { return x >= 3 && x < edge - 3; };
      const bool isBox =
          isInside(i % edge) && isInside(i / edge % edge) && isInside(i / edge / edge);
      int noise = -60; // the sum of 8 numbers has a standard deviation of 13.0
      for (int k = 0; k < 8; ++k)
        noise += static_cast<int>(random() % 16);
      const bool isIsland = i == edge * edge + edge + 1;
      append(isIsland ? 1200 : isBox ? 60 : -1000, clean);
      append((isIsland ? 1200 : isBox ? 60 : -1000) + noise, noisy);
      append((isIsland ? 2200 : isBox ? 1060 : 100) + noise, mr);
    }
    const NrrdText text{.sizes = "20 20 20"};
    folder.write("noisy.nrrd", text.encode(noisy));
    folder.write("clean.nrrd", text.encode(clean));
    folder.write("mr.nrrd", text.encode(mr));
  }

  Outcome render(const Arguments& arguments, const std::string& volume = "noisy.nrrd",
                 const std::string& samples = "2") const {
    Arguments all = {volume, "--size", "16x16", "--samples", samples, "--progress", "none"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const Outcome outcome = run(all, folder.path());
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome;
  }
  nlohmann::json readStats(const std::string& file) const {
    return nlohmann::json::parse(readBytes(folder / file));
  }
  bool isSmoothed(const std::string& image) const {
    return readImage(folder / image).header.contains("volume");
  }

  static constexpr int edge = 20;
  TemporaryFolder folder;

private:
  static void append(int value, std::string& samples) {
    samples += static_cast<char>(value & 0xff);
    samples += static_cast<char>(value >> 8 & 0xff);
  }
};

TEST_F(SmoothingCommand, MeasurementsAloneStayRaw) {
  render({"--volume-smoothing", "off", "-o", "off.exr"});
  render({"--volume-smoothing", "auto", "-o", "auto.exr", "-o", "auto.nrrd", "--stats-json",
          "auto.json"});
  expectSameImage(folder / "off.exr", folder / "auto.exr");
  EXPECT_FALSE(isSmoothed("auto.exr"));
  EXPECT_FALSE(readStats("auto.json").contains("volumeSmoothing"));
}

TEST_F(SmoothingCommand, AllOutputsShowTheMediumOfTheDisplayImage) {
  render({"--volume-smoothing", "off", "-o", "off.exr", "--stats-json", "off.json"});
  render({"--volume-smoothing", "auto", "-o", "alone.png"});
  const Outcome both = render({"--volume-smoothing", "auto", "-o", "both.exr", "-o", "both.png",
                               "-o", "both.nrrd", "--stats-json", "both.json", "--verbose"});
  EXPECT_EQ(readBytes(folder / "alone.png"), readBytes(folder / "both.png"));
  EXPECT_NE(readImage(folder / "both.exr").channels, readImage(folder / "off.exr").channels);
  EXPECT_EQ(readImage(folder / "both.exr").header.at("camera"),
            readImage(folder / "off.exr").header.at("camera"));
  EXPECT_TRUE(isSmoothed("both.exr"));
  for (const char* file : {"both.png", "both.nrrd"})
    EXPECT_NE(readBytes(folder / file).find("non-local means"), std::string::npos) << file;
  EXPECT_NE(both.messages.find("non-local means"), std::string::npos) << both.messages;

  EXPECT_FALSE(readStats("off.json").contains("volumeSmoothing"));
  const nlohmann::json smoothing = readStats("both.json").at("volumeSmoothing");
  EXPECT_NEAR(smoothing.at("noise"), 13.0, 2.0);
  EXPECT_GT(smoothing.at("strength"), 10.0);
  EXPECT_EQ(smoothing.at("method"), "non-local means");
  EXPECT_EQ(smoothing.at("lesionContrast").size(), 3U);
}

TEST_F(SmoothingCommand, ContrastOfLesionsIsOnlyThatMeasuredInCt) {
  const auto renderText = [&](const std::string& volume) {
    render({"--volume-smoothing", "auto", "-o", "a.png", "--stats-json", "s.json"}, volume);
    EXPECT_GT(readStats("s.json").at("volumeSmoothing").at("strength"), 0.0) << volume;
    return readBytes(folder / "a.png");
  };
  EXPECT_EQ(renderText("mr.nrrd").find("47 %"), std::string::npos);
  EXPECT_FALSE(readStats("s.json").at("volumeSmoothing").contains("lesionContrast"));
  EXPECT_NE(renderText("noisy.nrrd").find("47 %"), std::string::npos);
  EXPECT_DOUBLE_EQ(readStats("s.json").at("volumeSmoothing").at("lesionContrast").at("4 mm"), 0.47);
}

TEST_F(SmoothingCommand, VolumeWithoutNoiseIsUnchanged) {
  render({"--volume-smoothing", "off", "-o", "off.png"}, "clean.nrrd");
  render({"--volume-smoothing", "auto", "-o", "auto.png", "--stats-json", "s.json"}, "clean.nrrd");
  EXPECT_EQ(readBytes(folder / "off.png"), readBytes(folder / "auto.png"));
  EXPECT_EQ(readStats("s.json").at("volumeSmoothing").at("method"), "none");
}

TEST_F(SmoothingCommand, GivenNoiseAppliesToEveryRequest) {
  render({"--volume-smoothing", "15", "-o", "given.exr", "--stats-json", "s.json"}, "clean.nrrd");
  EXPECT_TRUE(isSmoothed("given.exr"));
  EXPECT_EQ(readStats("s.json").at("volumeSmoothing").at("noise"), 15.0);
}

TEST_F(SmoothingCommand, IslandsOfOpacityAreRemovedWithTheNoise) {
  const std::string knots = R"("extinction": [[20, 0], [300, 50]], "color": [[20, "#808080"]])";
  const auto renderAlpha = [&](const std::string& kind, const std::string& islands) {
    render({"--volume-smoothing", kind, "--transfer", "{" + knots + islands + "}", "--background",
            "transparent", "-o", "a.png", "-o", "a.exr", "--stats-json", "s.json"});
    return readImage(folder / "a.exr").channels.at("A");
  };
  const auto raw = renderAlpha("off", R"(, "islands": 9)");
  EXPECT_FALSE(readStats("s.json").contains("volumeSmoothing"));
  const auto countLost = [&](const auto& alpha) {
    int lost = 0;
    for (std::size_t i = 0; i < raw.size(); ++i)
      lost += raw[i] > 0.0F && alpha[i] == 0.0F;
    return lost;
  };
  const auto whole = renderAlpha("auto", "");
  EXPECT_EQ(countLost(whole), 0) << "smoothing alone";
  const auto alpha = renderAlpha("auto", R"(, "islands": 9)");
  EXPECT_GE(countLost(alpha), 1) << "the island";
  EXPECT_LE(countLost(alpha), 4) << "the box remains";
  EXPECT_GT(std::ranges::count(alpha, 1.0F), 50);
  const nlohmann::json smoothing = readStats("s.json").at("volumeSmoothing");
  EXPECT_EQ(smoothing.at("islands").at("count"), 1);
  EXPECT_EQ(smoothing.at("islands").at("mm3"), 1.0);

  std::string labels(edge * edge * edge, '\0'); // a focus of 2^3 voxels
  for (const int i : {0, 1, 2, 3, 4, 5, 6, 7})
    labels[static_cast<std::size_t>(1 + i % 2 + edge * (1 + i / 2 % 2 + edge * (1 + i / 4)))] = 1;
  folder.write("labels.nrrd", NrrdText{.sizes = "20 20 20", .type = "uint8"}.encode(labels));
  render({"--volume-smoothing", "auto", "--transfer", "{" + knots + R"(, "islands": 9})",
          "--segmentation", "labels.nrrd", "--focus", "1", "-o", "a.png", "--stats-json",
          "s.json"});
  const nlohmann::json focused = readStats("s.json").at("volumeSmoothing");
  EXPECT_EQ(focused.at("islands").at("count"), 0);
  EXPECT_EQ(focused.at("islands").at("mm3"), 0.0);
}

TEST_F(SmoothingCommand, ResumedRenderShowsTheMediumOfItsCheckpoint) {
  struct Medium {
    std::string begun;    ///< output of the first run
    std::string given;    ///< to it
    std::string expected; ///< of the image of the second run
    Arguments outputs;    ///< of the second run
  };
  const Medium media[] = {{"raw.exr", "auto", "off", {"-o", "a.exr", "-o", "a.png"}},
                          {"shown.png", "auto", "auto", {"-o", "a.exr"}},
                          {"given.exr", "15", "15", {"-o", "a.exr"}}};
  for (const auto& [begun, given, expected, outputs] : media) {
    SCOPED_TRACE(begun);
    render({"--checkpoint", begun + ".film", "--volume-smoothing", given, "-o", begun});
    Arguments resumed = outputs;
    resumed.insert(resumed.end(), {"--checkpoint", begun + ".film"});
    const Outcome outcome = render(resumed, "noisy.nrrd", "3");
    EXPECT_NE(outcome.err.find("--volume-smoothing"), std::string::npos) << outcome.err;
    render({"--volume-smoothing", expected, "-o", "once.exr", "-o", "once.png"}, "noisy.nrrd", "3");
    expectSameImage(folder / "once.exr", folder / "a.exr");
    EXPECT_EQ(isSmoothed("a.exr"), expected != "off");
  }
  for (const char* begun : {"raw.exr", "shown.png"}) { // as the outputs would choose
    const Outcome outcome =
        render({"--checkpoint", std::string(begun) + ".film", "-o", begun}, "noisy.nrrd", "3");
    EXPECT_EQ(outcome.err.find("--volume-smoothing"), std::string::npos) << outcome.err;
  }
}

TEST_F(SmoothingCommand, ExplicitSmoothingMustBeThatOfTheCheckpoint) {
  struct Contradiction {
    std::string begun, other;
  };
  for (const auto& [begun, other] : {Contradiction{"a.exr", "15"}, Contradiction{"a.png", "off"},
                                     Contradiction{"a.png", "15"}}) {
    const std::string film = begun + ".film";
    render({"--checkpoint", film, "-o", begun});
    const Outcome outcome = run({"noisy.nrrd", "--size", "16x16", "--samples", "2",
                                 "--volume-smoothing", other, "--checkpoint", film, "-o", begun},
                                folder.path());
    EXPECT_EQ(outcome.status, 2) << begun << ' ' << other;
    EXPECT_NE(outcome.err.find("--volume-smoothing"), std::string::npos) << outcome.err;
    render({"--checkpoint", film, "-o", begun}); // still resumes
  }
}

TEST_F(SmoothingCommand, ShardsAreOfTheRawVolumeAndMergeSaysSo) {
  for (const char* shard : {"1/2", "2/2"})
    render({"--volume-smoothing", "auto", "--shard", shard, "--checkpoint",
            shard[0] == '1' ? "1.film" : "2.film"});
  render({"--volume-smoothing", "off", "-o", "off.exr"});
  const Outcome merged =
      run({"merge", "1.film", "2.film", "-o", "merged.exr", "-o", "merged.png"}, folder.path());
  ASSERT_EQ(merged.status, 0) << merged.err;
  expectSameImage(folder / "off.exr", folder / "merged.exr");
  EXPECT_NE(merged.err.find("--volume-smoothing"), std::string::npos) << merged.err;

  render({"--volume-smoothing", "auto", "--checkpoint", "shown.film", "-o", "shown.png"});
  const Outcome again = run({"merge", "shown.film", "-o", "again.exr"}, folder.path());
  ASSERT_EQ(again.status, 0) << again.err;
  EXPECT_TRUE(isSmoothed("again.exr"));
}

TEST_F(SmoothingCommand, ServerShowsTheSmoothedVolumeInEveryFile) {
  Process server({"serve", "noisy.nrrd", "--size", "16x16", "--samples", "2", "--volume-smoothing",
                  "auto", "-o", "a.exr"},
                 folder.path());
  const auto waitForImage = [&](const std::string& id) {
    return server.waitForOutput("\"picture\",\"id\":" + id + ",[^\n]*\"done\":true[^\n]*\n");
  };
  ASSERT_TRUE(waitForImage("null")) << server.output();
  EXPECT_TRUE(isSmoothed("a.exr"));
  server.write("{\"id\": 1, \"volume-smoothing\": \"off\"}\n");
  ASSERT_TRUE(waitForImage("1")) << server.output();
  EXPECT_FALSE(isSmoothed("a.exr"));
  server.write("{\"id\": 2, \"volume-smoothing\": \"auto\"}\n");
  ASSERT_TRUE(waitForImage("2")) << server.output();
  EXPECT_TRUE(isSmoothed("a.exr"));
}

TEST_F(SmoothingCommand, RowsOfABatchReuseTheSmoothedVolume) {
  struct Row {
    std::string name, input, view, smoothing;
    bool isReused;
  };
  const Row rows[] = {
      {"a", "noisy.nrrd", "anterior", "auto", false}, {"b", "noisy.nrrd", "left", "auto", true},
      {"c", "noisy.nrrd", "left", "15", false},       {"d", "clean.nrrd", "left", "15", false},
      {"e", "clean.nrrd", "anterior", "15", true},    {"f", "noisy.nrrd", "left", "auto", false}};
  std::string table = "name,input,view,volume-smoothing\n";
  for (const auto& [name, input, view, smoothing, isReused] : rows)
    table += name + "," + input + "," + view + "," + smoothing + "\n";
  folder.write("t.csv", table);
  const Outcome batch = run(
      {"batch", "t.csv", "-o", "out", "--size", "16x16", "--samples", "2", "--progress", "none"},
      folder.path());
  ASSERT_EQ(batch.status, 0) << batch.err;
  for (const Row& row : rows) {
    const std::string base = "out/" + row.name + "/" + row.name;
    const nlohmann::json smoothing = readStats(base + ".json").at("volumeSmoothing");
    EXPECT_EQ(smoothing.at("reused"), row.isReused) << row.name;
    render({"--view", row.view, "--volume-smoothing", row.smoothing, "-o", "alone.png",
            "--stats-json", "alone.json"},
           row.input);
    EXPECT_EQ(readBytes(folder / (base + ".png")), readBytes(folder / "alone.png")) << row.name;
    nlohmann::json alone = readStats("alone.json").at("volumeSmoothing");
    EXPECT_EQ(alone.at("reused"), false);
    alone["reused"] = row.isReused;
    EXPECT_EQ(smoothing, alone) << row.name;
  }
}

TEST_F(SmoothingCommand, RejectsOtherValues) {
  for (const char* value : {"on", "-3", "nan", "1,2", "3 HU"}) {
    const Outcome outcome = run(
        {"noisy.nrrd", std::string("--volume-smoothing=") + value, "-o", "a.png"}, folder.path());
    EXPECT_EQ(outcome.status, 2) << value;
    EXPECT_NE(outcome.err.find("--volume-smoothing: "), std::string::npos) << outcome.err;
  }
}

} // namespace
} // namespace fenestra::core::SmoothingCommandTests
