// Input: opened once for everything that is read from it; lists the files of each read.

#include "scene/NamedPresets.h"
#include "scene/PreparedScene.h"

#include "SceneTesting.h"

namespace fenestra::InputTests {
namespace {

/// Archive with a CT, a label map on the same grid, and a volume property.
class ArchiveInput : public ::testing::Test {
protected:
  ArchiveInput() {
    FileGeometry geometry;
    geometry.origin = {10, 20, 30};
    geometry.spacing = {1, 2, 3};
    writeFile(folder / "labels.nrrd", std::vector<std::uint8_t>(24, 5), geometry);
    writeArchive(archive, {{"a/a.mrml", "<MRML>" + volumeNode + R"(
                              <LabelMapVolume id="l" name="L" storageNodeRef="m"/>
                              <VolumeArchetypeStorage id="m" fileName="labels.nrrd"/>
                              <VolumeProperty id="p" name="P"
                                scalarOpacity="4 0 0 200 1" colorTransfer="8 0 1 1 1 200 1 1 1"/>
                              </MRML>)"},
                           {"a/ct.nrrd", readBytes(folder / "ct.nrrd")},
                           {"a/labels.nrrd", readBytes(folder / "labels.nrrd")}});
  }

  const SceneFolder folder;
  const std::filesystem::path archive = folder / "a.mrb";
};

TEST_F(ArchiveInput, IsOpenedOnceForAllCopies) {
  const Input input(archive), copy = input;
  ASSERT_TRUE(input.document());
  std::filesystem::remove(archive); // opening it again would fail
  const Volume volume = copy.volume({}).volume;
  EXPECT_EQ(volume.name, "CT");
  EXPECT_EQ(copy.segments({{}, "L"}, volume.grid).segmentation.segments().size(), 1U);
  EXPECT_TRUE(input.segmentNames({{}, "L"}));
  EXPECT_TRUE(input.property("P").transfer);
  EXPECT_EQ(input.propertyNames(), std::vector<std::string>{"P"});
}

TEST_F(ArchiveInput, IsOpenedOnceForSceneAndChanges) {
  RenderRequest request;
  request.input = archive;
  request.transfer = "P";
  request.width = request.height = 8;
  const Input input(archive);
  ASSERT_TRUE(input.document());
  std::filesystem::remove(archive);
  const PreparedScene scene(request, input);
  request.segmentation = "L";
  request.focus = {"5"};
  const PreparedScene changed = scene.withRequest(request);
  EXPECT_FALSE(changed.updatedStages().volume);
  EXPECT_TRUE(changed.focus());
}

TEST_F(ArchiveInput, ListsTheFilesOfEachRead) {
  const std::string inArchive = archive.string() + "/a/";
  const Input input(archive);
  const VolumeInput read = input.volume({});
  EXPECT_EQ(read.files, (InputFiles{archive.string(), inArchive + "ct.nrrd"}));
  EXPECT_EQ(input.segments({{}, "L"}, read.volume.grid).files,
            (InputFiles{archive.string(), inArchive + "labels.nrrd"}));
  EXPECT_EQ(input.settings({}, true).files, InputFiles{archive.string()});
}

TEST(Input, FromAVolumeFileHasNoSceneOrSettings) {
  const SceneFolder folder;
  const Input input(folder / "ct.nrrd");
  EXPECT_FALSE(input.document());
  EXPECT_FALSE(input.property("P").transfer);
  EXPECT_FALSE(input.segmentNames({}));
  EXPECT_FALSE(input.settings({}, true).camera);
  EXPECT_EQ(input.volume({}).files, InputFiles{(folder / "ct.nrrd").string()});
}

TEST(InlineJson, BraceDistinguishesJsonFromNames) {
  EXPECT_TRUE(isInlineJson(R"({"lights": []})"));
  EXPECT_TRUE(isInlineJson("{"));
  for (const char* name : {"", "studio", "lights.json", "./{.json", " {}"})
    EXPECT_FALSE(isInlineJson(name)) << name;
}

} // namespace
} // namespace fenestra::InputTests
