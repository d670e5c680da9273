// Folders of image slices on the command line.

#include "InspectTesting.h"
#include "TiffPages.h"

namespace fenestra::core::StackCommandTests {
namespace {

class StackCommand : public InspectCommand {
protected:
  StackCommand() {
    std::filesystem::create_directory(folder / "scan 1");
    for (std::size_t z = 0; z < 4; ++z)
      folder.write(
          "scan 1/slice" + std::to_string(z + 8) + ".tif",
          TiffPages{.columns = 4, .rows = 4, .bits = 16}.encode({makeRamp().substr(32 * z, 32)}));
    folder.write("scan 1/scan.log", "parameters");
  }
};

TEST_F(StackCommand, InspectListsAStackWithoutASpacing) {
  const Json report = inspect({"scan 1"});
  EXPECT_EQ(report["kind"], "volume");
  ASSERT_EQ(report["volumes"].size(), 1U);
  EXPECT_EQ(report["volumes"][0]["size"], (Json{4, 4, 4}));
  EXPECT_EQ(report["volumes"][0]["files"].size(), 4U);
  EXPECT_NE(text.find("fenestra 'scan 1' --spacing X,Y,Z --output image.png\n"), std::string::npos)
      << text;
  expectSameAsRender(report, "scan 1");
}

TEST_F(StackCommand, InspectShowsWhatARenderWithASpacingUses) {
  for (const char* spacing : {"0.5", "0.5,0.5,0.5"}) {
    const Json report = inspect({"scan 1", "--spacing", spacing});
    EXPECT_EQ(report["refused"], nullptr);
    EXPECT_EQ(report["render"]["volume"]["spacing"], (Json{0.5, 0.5, 0.5}));
    EXPECT_EQ(report["render"]["volume"]["range"], (Json{0.0, 63.0}));
    EXPECT_NE(text.find("fenestra 'scan 1' --spacing 0.5,0.5,0.5 --output image.png\n"),
              std::string::npos)
        << text;
  }
}

TEST_F(StackCommand, RendersAloneAndInABatch) {
  const Arguments quick = {"--size", "4x4", "--samples", "1", "--quiet"};
  Arguments render = {"scan 1", "--spacing", "1", "--output", "a.png"};
  render.insert(render.end(), quick.begin(), quick.end());
  const Outcome outcome = run(render, folder.path());
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_TRUE(std::filesystem::exists(folder / "a.png"));
  folder.write("t.csv", "name,input,spacing\na,scan 1,1\nb,scan 1,\"0.1,0.2,0.3\"\nc,scan 1,\n");
  Arguments batch = {"batch", "t.csv", "--output", "out"};
  batch.insert(batch.end(), quick.begin(), quick.end());
  const Outcome rows = run(batch, folder.path());
  EXPECT_NE(rows.err.find("--spacing"), std::string::npos) << rows.err; // of row c
  EXPECT_TRUE(std::filesystem::exists(folder / "out/b/b.png"));
  EXPECT_FALSE(std::filesystem::exists(folder / "out/c/c.png"));
}

TEST_F(StackCommand, RejectsInvalidSpacings) {
  expectErrors(
      {
          {"none", {"scan 1"}, 3, "scan 1: | --spacing"},
          {"zero", {"scan 1", "--spacing", "0"}, 2, "--spacing:"},
          {"two numbers", {"scan 1", "--spacing", "1,2"}, 2, "--spacing: | 3 numbers"},
          {"a negative one", {"scan 1", "--spacing", "1,-2,1"}, 2, "--spacing:"},
          {"a stated one", {"volume.nrrd", "--spacing", "2"}, 3, "volume.nrrd:"},
          {"a frame", {"scan 1", "--spacing", "1", "--frame", "1"}, 3, "scan 1: | 1 frame"},
          {"a volume", {"scan 1", "--spacing", "1", "--volume", "a"}, 2, "--volume:"},
      },
      folder.path());
}

} // namespace
} // namespace fenestra::core::StackCommandTests
