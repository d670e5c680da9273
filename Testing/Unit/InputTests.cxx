// Input: opened once for everything that is read from it; lists the files of each read.

#include "scene/NamedPresets.h"
#include "scene/PreparedScene.h"

#include "SceneTesting.h"

namespace fenestra::core::InputTests {
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
  const Volume volume = copy.volume({})->volume;
  EXPECT_EQ(volume.name, "CT");
  EXPECT_EQ(copy.segments({{}, "L"}, volume.grid)->segmentation.segments().size(), 1U);
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

/// Scene with two visible segmentations, whose segments share ids and label values, a hidden one,
/// and a label map with a color table.
class SeveralSegmentations : public ::testing::Test {
protected:
  SeveralSegmentations() {
    const auto write = [&](const char* file, const char* id, const char* name, std::size_t from) {
      FileGeometry geometry;
      addSegment(geometry, 0, id, name, "1", "0");
      std::vector<std::uint8_t> labels(24, 0);
      std::fill_n(labels.begin() + static_cast<std::ptrdiff_t>(from), 4, std::uint8_t{1});
      writeFile(folder / file, labels, geometry);
    };
    write("a.seg.nrrd", "S1", "Liver", 0);
    write("b.seg.nrrd", "S1", "Tumour", 2);
    write("c.seg.nrrd", "S2", "Spleen", 12);
    std::vector<std::uint8_t> labels(24, 0);
    labels[7] = 5;
    labels[8] = 6;
    writeFile(folder / "map.nrrd", labels);
    folder.write("map.ctbl", "5 Duodenum 10 20 30 255\n");
    std::string text = "<MRML>" + volumeNode;
    for (const char* node : {"a", "b", "c"})
      text += concat("<SegmentationStorage id=\"s", node, "\" fileName=\"", node,
                     ".seg.nrrd\"/><SegmentationDisplay id=\"d", node, "\" visibility=\"",
                     std::string(node) == "c" ? "false" : "true", "\"/><Segmentation id=\"", node,
                     "\" name=\"", node, "\" references=\"display:d", node, ";storage:s", node,
                     ";\"/>");
    text += R"(<VolumeArchetypeStorage id="sm" fileName="map.nrrd"/>
      <ColorTableStorage id="st" fileName="map.ctbl"/>
      <ColorTable id="t" name="T" references="storage:st;"/>
      <LabelMapVolumeDisplay id="dm" references="color:t;"/>
      <LabelMapVolume id="m" name="M" references="display:dm;storage:sm;"/></MRML>)";
    folder.write("s.mrml", text);
  }

  Segmentation read(const std::vector<std::string>& focus) const {
    return input.segments({.focus = focus})->segmentation;
  }
  std::int64_t count(const std::vector<std::string>& focus) const {
    const Segmentation segmentation = read(focus);
    return segmentation.makeFocusMask(focus, segmentation.grid()).count;
  }

  const SceneFolder folder;
  const Input input = Input(folder / "s.mrml");
};

TEST_F(SeveralSegmentations, FocusFindsTheNodeOfItsSegments) {
  EXPECT_EQ(read({"Tumour"}).segments().size(), 1U);
  EXPECT_EQ(count({"Liver"}), 4);
  EXPECT_EQ(count({"Liver", "Tumour"}), 6) << "two voxels belong to both";
  EXPECT_EQ(count({"Spleen", "Liver"}), 8) << "hidden, but no visible one has it";
  EXPECT_EQ(count({"Duodenum", "Tumour"}), 5) << "named by the color table";
  EXPECT_EQ(read({"Liver", "Tumour"}).segments().size(), 2U);
  EXPECT_EQ(input.segments({.focus = {"Tumour"}})->files,
            (InputFiles{(folder / "s.mrml").string(), (folder / "a.seg.nrrd").string(),
                        (folder / "b.seg.nrrd").string()}));
}

TEST_F(SeveralSegmentations, OffersTheNamesOfAllVisibleOnes) {
  const auto list = [&](const InputChoice& choice) {
    const std::optional<SegmentNames> found = input.segmentNames(choice);
    std::vector<std::string> names;
    for (const SegmentInfo& segment : found->segments)
      names.push_back(segment.name);
    return names;
  };
  EXPECT_EQ(list({}), (std::vector<std::string>{"Liver", "Tumour"}));
  EXPECT_EQ(list({.segmentation = "c"}), std::vector<std::string>{"Spleen"});
}

TEST_F(SeveralSegmentations, AmbiguousAndUnknownSegmentsAreRefused) {
  expectRefused(folder / "s.mrml", "ambiguous-segmentation | S1 | a | b", [&] { read({"S1"}); });
  expectRefused(folder / "s.mrml", "ambiguous-segmentation | Heart", [&] { read({"Heart"}); });
  EXPECT_EQ(input.segments({.segmentation = "b", .focus = {"S1"}})->segmentation.segments().size(),
            1U);
}

TEST_F(ArchiveInput, ListsTheFilesOfEachRead) {
  const std::string inArchive = archive.string() + "/a/";
  const Input input(archive);
  const VolumeInput read = *input.volume({});
  EXPECT_EQ(read.files, (InputFiles{archive.string(), inArchive + "ct.nrrd"}));
  EXPECT_EQ(input.segments({{}, "L"}, read.volume.grid)->files,
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
  EXPECT_EQ(input.volume({})->files, InputFiles{(folder / "ct.nrrd").string()});
}

TEST(InlineJson, BraceDistinguishesJsonFromNames) {
  EXPECT_TRUE(isInlineJson(R"({"lights": []})"));
  EXPECT_TRUE(isInlineJson("{"));
  for (const char* name : {"", "studio", "lights.json", "./{.json", " {}"})
    EXPECT_FALSE(isInlineJson(name)) << name;
}

} // namespace
} // namespace fenestra::core::InputTests
