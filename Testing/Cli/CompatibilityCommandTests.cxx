// What version 0.1 (commit af3ffce) wrote and accepted. The files in Data/version-0.1 are inputs as
// it read them; the images there are what 0.2 rendered from them when its defaults had changed,
// with FENESTRA_INSTRUCTIONS=SCALAR.

#include "CommandTesting.h"
#include "files/images/ImageReader.h"

#include <nlohmann/json.hpp>

#include <filesystem>

namespace fenestra::core::CompatibilityCommandTests {
namespace {

namespace fs = std::filesystem;

class Compatibility : public ::testing::Test {
protected:
  Compatibility() {
    for (const auto& file : fs::directory_iterator(FENESTRA_VERSION_0_1))
      fs::copy(file, folder / file.path().filename());
    setenv("FENESTRA_INSTRUCTIONS", "SCALAR", 1);
  }
  ~Compatibility() override { unsetenv("FENESTRA_INSTRUCTIONS"); }

  /// Runs the command, which must succeed, and compares the image that it writes with the stored
  /// one. The tolerance allows for the last bits of another mathematics library.
  void expectImage(const Arguments& command, const std::string& written,
                   const std::string& expected) const {
    const Outcome outcome = run(command, folder.path());
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const Image image = readImage(folder / written), old = readImage(folder / expected);
    double sum = 0.0;
    for (const auto& [name, plane] : old.channels) {
      const auto& now = image.channels.at(name);
      ASSERT_EQ(now.size(), plane.size());
      for (std::size_t i = 0; i < plane.size(); ++i) {
        ASSERT_NEAR(now[i], plane[i], 1e-4 * (1.0 + std::abs(plane[i]))) << name << ' ' << i;
        sum += std::abs(plane[i]);
      }
    }
    EXPECT_GT(sum, 0.0);
  }

  Arguments makeArguments(const Arguments& options) const {
    Arguments all = {"volume.nrrd", "--segmentation", "segments.seg.nrrd", "--output", "new.exr",
                     "--layers",    "color"};
    all.insert(all.end(), options.begin(), options.end());
    return all;
  }

  TemporaryFolder folder;
};

TEST_F(Compatibility, StoredSceneRendersTheSameImage) {
  expectImage({"scene.mrml", "--output", "new.exr", "--layers", "color"}, "new.exr", "scene.exr");
}

TEST_F(Compatibility, PresetFileRendersTheSameImage) {
  expectImage(makeArguments({"--preset", "preset.json", "--size", "16x16", "--samples", "8"}),
              "new.exr", "preset.exr");
}

TEST_F(Compatibility, FormerPresetNameRendersTheSameImage) {
  for (const char* name : {"brain-tumour", "brain-tumor"})
    expectImage(makeArguments({"--preset", name, "--scale", "5", "--labelsmoothing", "0.5",
                               "--size", "16x16", "--samples", "8"}),
                "new.exr", "tumor.exr");
}

TEST_F(Compatibility, BatchTableRendersTheSameImagesByBothCommandNames) {
  for (const std::string command : {"study", "batch"}) {
    const Arguments arguments = {command,     "table.csv", "--output",  command,
                                 "--size",    "16x16",     "--samples", "8",
                                 "--formats", "exr",       "--layers",  "color"};
    for (const std::string row : {"first", "second"})
      expectImage(arguments, command + "/" + row + "/" + row + ".exr", row + ".exr");
    EXPECT_TRUE(fs::exists(folder / (command + "/study.csv")));
    EXPECT_TRUE(fs::exists(folder / (command + "/first/first.study.json")));
  }
}

/// Its samples are of other defaults and must not be mixed with new ones.
TEST_F(Compatibility, CheckpointIsRefusedAndKept) {
  const std::string checkpoint = readBytes(folder / "render.film");
  const Arguments options = {"--focus",    "Liver",  "--size",       "8x8",
                             "--samples",  "16",     "--transfer",   "transfer.json",
                             "--sampling", "strata", "--checkpoint", "render.film"};
  const Outcome outcome = run(makeArguments(options), folder.path());
  EXPECT_EQ(outcome.status, 2);
  expectErrorLine(outcome.err, "render.film: version");
  EXPECT_EQ(readBytes(folder / "render.film"), checkpoint);
  EXPECT_FALSE(fs::exists(folder / "new.exr"));
}

TEST_F(Compatibility, FormerValuesOfOptionsAreAccepted) {
  const auto renderStats = [&](const char* target) {
    const Outcome outcome = run({"volume.nrrd", "--size", "8x8", "--noise", "0.5", "--noisetarget",
                                 target, "--output", "new.png", "--stats", "stats.json"},
                                folder.path());
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return nlohmann::json::parse(readBytes(folder / "stats.json"));
  };
  const nlohmann::json old = renderStats("filtered"), now = renderStats("denoised");
  EXPECT_EQ(old["samplesPerPixel"], now["samplesPerPixel"]);
  EXPECT_EQ(now["noiseFiltered"], now["noiseDenoised"]);
  EXPECT_LE(now["noiseDenoised"], 0.5);
}

} // namespace
} // namespace fenestra::core::CompatibilityCommandTests
