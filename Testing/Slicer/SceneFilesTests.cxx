// Scenes that the extension writes for the renderer.

#include "TemporaryFolder.h"

#include "FenestraSceneFiles.h"

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <functional>
#include <numeric>
#include <system_error>

namespace fenestra::core {
namespace {

/// Image of ascending values; its matrix has numbers that need all digits.
SlicerExport::Image makeRamp(std::array<std::size_t, 3> size) {
  SlicerExport::Image image;
  image.type = "int16";
  image.size = size;
  const auto values = std::make_shared<std::vector<std::int16_t>>(size[0] * size[1] * size[2]);
  std::iota(values->begin(), values->end(), std::int16_t(-3));
  image.data = std::shared_ptr<const void>(values, values->data());
  image.ijkToRas = {0.1, 0, 0, 1.0 / 3.0, 0, 2, 0, -7, 0, 0, 3, 1e-9, 0, 0, 0, 1};
  return image;
}

/// Layer of 2 x 2 x 2 voxels, all with one label, from grid index `begin`.
SlicerExport::Layer makeBlock(std::array<long, 3> begin, std::uint8_t label) {
  SlicerExport::Layer layer;
  layer.labels.type = "uint8";
  layer.labels.size = {2, 2, 2};
  const auto values = std::make_shared<std::vector<std::uint8_t>>(8, label);
  layer.labels.data = std::shared_ptr<const void>(values, values->data());
  layer.begin = begin;
  for (std::size_t axis = 0; axis < 3; ++axis)
    layer.labels.ijkToRas[4 * axis + 3] = static_cast<double>(begin[axis]);
  return layer;
}

TEST(SlicerSceneFiles, ImageRoundTripsBitForBit) {
  const TemporaryFolder folder;
  const SlicerExport::Image image = makeRamp({3, 4, 5});
  SlicerExport::writeNrrd(image, folder / "image.nrrd");
  const SlicerExport::Image again = SlicerExport::readNrrd(folder / "image.nrrd");
  EXPECT_EQ(again.type, image.type);
  EXPECT_EQ(again.size, image.size);
  EXPECT_EQ(again.ijkToRas, image.ijkToRas); // all digits
  ASSERT_EQ(again.bytes(), image.bytes());
  EXPECT_EQ(std::memcmp(again.data.get(), image.data.get(), image.bytes()), 0);
}

TEST(SlicerSceneFiles, DamagedNrrdAndMissingFolderAreRejected) {
  const TemporaryFolder folder;
  SlicerExport::writeNrrd(makeRamp({3, 4, 5}), folder / "image.nrrd");
  std::filesystem::resize_file(folder / "image.nrrd",
                               std::filesystem::file_size(folder / "image.nrrd") - 1);
  EXPECT_THROW(SlicerExport::readNrrd(folder / "image.nrrd"), SlicerExport::FileError);
  folder.write("empty.nrrd", "");
  folder.write("other.nrrd", "NRRD0004\ntype: float\n\n");
  EXPECT_THROW(SlicerExport::readNrrd(folder / "empty.nrrd"), SlicerExport::FileError);
  EXPECT_THROW(SlicerExport::readNrrd(folder / "other.nrrd"), SlicerExport::FileError);
  EXPECT_THROW(SlicerExport::writeNrrd(makeRamp({1, 1, 1}), folder / "none" / "image.nrrd"),
               SlicerExport::FileError);
}

/// The message has the system's reason, not a guess.
TEST(SlicerSceneFiles, ErrorsHaveTheirReason) {
  const TemporaryFolder folder;
  folder.write("file", "");
  const auto getReason = [](const std::function<void()>& write) {
    try {
      write();
      return std::string();
    } catch (const SlicerExport::FileError& error) {
      const std::string message = error.what();
      return message.substr(message.rfind(": ") + 2);
    }
  };
  const auto reason = [](std::errc code) { return std::make_error_code(code).message(); };
  const SlicerExport::Image ramp = makeRamp({1, 1, 1});
  EXPECT_EQ(getReason([&] { SlicerExport::writeNrrd(ramp, folder / "none" / "image.nrrd"); }),
            reason(std::errc::no_such_file_or_directory));
  SlicerExport::Contents contents;
  contents.volume = ramp;
  EXPECT_EQ(getReason([&] { SlicerExport::Writer(folder / "file").write(contents); }),
            reason(std::errc::not_a_directory));
  SlicerExport::Writer(folder / "new" / "folder").write(contents); // created
}

TEST(SlicerSceneFiles, ComposedLayersKeepTheirPositions) {
  const SlicerExport::Image both =
      SlicerExport::composeLayers({makeBlock({0, 0, 0}, 1), makeBlock({1, -1, 0}, 2)});
  EXPECT_EQ(both.components, 2u);
  EXPECT_EQ(both.size, (std::array<std::size_t, 3>{3, 3, 2}));
  EXPECT_EQ(both.ijkToRas[7], -1.0);
  const auto* labels = static_cast<const std::uint8_t*>(both.data.get());
  const auto labelAt = [&](std::size_t i, std::size_t j, std::size_t k, std::size_t layer) {
    return int(labels[((k * 3 + j) * 3 + i) * 2 + layer]);
  };
  EXPECT_EQ(labelAt(0, 1, 0, 0), 1);
  EXPECT_EQ(labelAt(0, 0, 0, 0), 0);
  EXPECT_EQ(labelAt(1, 0, 0, 1), 2);
  EXPECT_EQ(labelAt(0, 1, 0, 1), 0);
  EXPECT_EQ(labelAt(1, 1, 1, 0), 1); // the layers overlap here
  EXPECT_EQ(labelAt(1, 1, 1, 1), 2);
}

TEST(SlicerSceneFiles, UnchangedVolumeIsLinked) {
  const TemporaryFolder folder;
  SlicerExport::Writer writer(folder.path());
  SlicerExport::Contents contents;
  contents.volume = makeRamp({3, 4, 5});
  contents.volumeKey = "a";
  const auto first = writer.write(contents);
  const auto second = writer.write(contents);
  EXPECT_TRUE(std::filesystem::equivalent(first.parent_path() / "volume.nrrd",
                                          second.parent_path() / "volume.nrrd"));
  contents.volumeKey = "b";
  const auto third = writer.write(contents);
  EXPECT_FALSE(std::filesystem::equivalent(first.parent_path() / "volume.nrrd",
                                           third.parent_path() / "volume.nrrd"));
}

TEST(SlicerSceneFiles, TagsOfSegmentsAreWrittenOnOneLine) {
  const TemporaryFolder folder;
  SlicerExport::Contents contents;
  contents.volume = makeRamp({3, 4, 5});
  contents.segmentation.layers = {makeBlock({0, 0, 0}, 1)};
  contents.segmentation.segments = {{"a", "A", 1, 0, "TerminologyEntry:b~SCT^1^\nc|"},
                                    {"d", "D", 2, 0, ""}};
  const auto scene = SlicerExport::Writer(folder.path()).write(contents);
  const SlicerExport::Image labels =
      SlicerExport::readNrrd(scene.parent_path() / "segmentation.seg.nrrd");
  EXPECT_EQ(labels.size[0], 2u);
  std::ifstream file(scene.parent_path() / "segmentation.seg.nrrd");
  const std::string text((std::istreambuf_iterator<char>(file)), {});
  EXPECT_NE(text.find("\nSegment0_Tags:=TerminologyEntry:b~SCT^1^ c|\n"), std::string::npos);
  EXPECT_EQ(text.find("Segment1_Tags"), std::string::npos); // has no tags
}

TEST(SlicerSceneFiles, SegmentNamesHaveSlicersColorsAndNewLabelValues) {
  const TemporaryFolder folder;
  SlicerExport::writeSegmentNames(
      // label 7 of layer 3, and default label, layer and color
      {{"a", "A", 7, 3, "", {0.9450980392, 0.5, 1.0 / 3.0}}, {"b", "B"}},
      folder / "names.seg.nrrd");
  const std::string header = readBytes(folder / "names.seg.nrrd");
  for (const char* field :
       {"Segment0_Color:=0.945098 0.5 0.333333", "Segment0_LabelValue:=1", "Segment0_Layer:=0",
        "Segment1_Color:=0.5 0.5 0.5", "Segment1_LabelValue:=2"})
    EXPECT_NE(header.find(std::string("\n") + field + "\n"), std::string::npos) << field;
}

} // namespace
} // namespace fenestra::core
