// Source of the names of a label map's values: the user's table, the file, or a table beside it.

#include "NiftiFile.h"
#include "Refusals.h"

#include "base/Text.h"
#include "files/segments/LabelNames.h"
#include "files/segments/SegmentationReader.h"

#include <gtest/gtest.h>

using namespace fenestra::core;

namespace {

/// Label table as TotalSegmentator writes it into a header extension.
std::string makeLabelXml(const LabelNames& names) {
  std::string xml =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?> <CaretExtension> <VolumeInformation "
      "Index=\"0\">   <LabelTable>\n";
  for (const auto& [value, label] : names)
    xml += concat("<Label Key=\"", value,
                  "\" Red=\"1.0\" Green=\"0.5\" Blue=\"0.0\" Alpha=\"1\"><![CDATA[", label.name,
                  "]]></Label>\n");
  return xml + "</LabelTable> </VolumeInformation></CaretExtension>\n        ";
}

/// Label map of 24 voxels with the values 0, 5 and 7.
std::string makeLabelMap(const std::string& extension = {}) {
  NiftiFile file;
  file.sformCode = 1;
  file.samples[3] = 5;
  file.samples[20] = 7;
  file.extension = extension;
  return file.bytes();
}

std::string findName(const Segmentation& segmentation, std::int32_t value) {
  for (const SegmentInfo& segment : segmentation.segments())
    if (segment.labelValue == value)
      return segment.name;
  return "none";
}

TEST(LabelSearch, RequestedTableNamesItsValuesOnly) {
  const TemporaryFolder folder;
  const auto map = folder.write("map.nii", makeLabelMap());
  const auto table = folder.write("names.ctbl", "5 liver 1 2 3 255\n9 spleen 1 2 3 255\n");
  const Segmentation named = readSegmentation(map, nullptr, table.string());
  EXPECT_EQ(findName(named, 5), "liver");
  EXPECT_EQ(findName(named, 7), "Segment_7");
  ASSERT_EQ(named.warnings().size(), 1u);
  expectMessage(named.warnings()[0], "unmatched-labels | 7");
  EXPECT_EQ(named.namesSource(), table.string());
  const Segmentation organs = readSegmentation(map, nullptr, "totalsegmentator1");
  EXPECT_EQ(findName(organs, 7), "aorta");
  EXPECT_TRUE(organs.warnings().empty());
  EXPECT_EQ(findName(readSegmentation(map, nullptr, "totalsegmentator2"), 7), "pancreas");
  EXPECT_EQ(named.makeFocusMask({"liver"}, named.grid()).count, 1);
  const auto other = folder.write("other.csv", "1,a\n2,b\n");
  expectRefused(map, "unmatched-labels | 5, 7",
                [&] { readSegmentation(map, nullptr, other.string()); });
  EXPECT_THROW(readSegmentation(map, nullptr, "nosuch"), Error);
}

TEST(LabelSearch, TableInTheFileIsUsedForEachVersion) {
  const TemporaryFolder folder;
  for (const auto& [version, organ] :
       {std::pair("totalsegmentator1", "aorta"), {"totalsegmentator2", "pancreas"}}) {
    const auto map =
        folder.write("map.nii", makeLabelMap(makeLabelXml(*findBuiltInLabelNames(version))));
    for (const std::optional<std::string>& requested :
         {std::optional<std::string>(), std::optional<std::string>("totalsegmentator")}) {
      const Segmentation named = readSegmentation(map, nullptr, requested);
      EXPECT_EQ(findName(named, 7), organ);
      EXPECT_EQ(named.namesSource(), requested ? version : map.string());
      EXPECT_EQ(readSegmentInfos(map, requested).size(), 2u);
    }
  }
  const auto plain = folder.write("plain.nii", makeLabelMap());
  expectRefused(plain, "unknown-label-version",
                [&] { readSegmentation(plain, nullptr, "totalsegmentator"); });
  const auto own = folder.write("own.nii", makeLabelMap(makeLabelXml({{5, {"tumor"}}})));
  EXPECT_EQ(findName(readSegmentation(own), 5), "tumor");
  expectRefused(own, "unknown-label-version",
                [&] { readSegmentation(own, nullptr, "totalsegmentator"); });
}

TEST(LabelSearch, TableBesideTheMapIsUsedIfItMatches) {
  const TemporaryFolder folder;
  const auto map = folder.write("map.nii", makeLabelMap());
  EXPECT_TRUE(readSegmentInfos(map).empty());
  const auto exact = folder.write("seg_labels.json", R"({"5": "a", "7": "b"})");
  EXPECT_EQ(findName(readSegmentation(map), 7), "b");
  EXPECT_EQ(readSegmentation(map).namesSource(), exact.string());
  EXPECT_EQ(readSegmentInfos(map).at(0).name, "a");
  // A table with more values belongs to another map, unless it has the stem of this map's name.
  folder.write("seg_labels.json", R"({"5": "a", "7": "b", "8": "c"})");
  const Segmentation unnamed = readSegmentation(map);
  EXPECT_EQ(findName(unnamed, 7), "Segment_7");
  ASSERT_EQ(unnamed.warnings().size(), 1u);
  expectMessage(unnamed.warnings()[0], "unused-labels: seg_labels.json | map.nii");
  EXPECT_TRUE(readSegmentInfos(map).empty());
  folder.write("map.csv", "5,x\n7,y\n8,z\n");
  EXPECT_EQ(findName(readSegmentation(map), 7), "y");
  folder.write("map.csv", "5,x\n");
  EXPECT_EQ(findName(readSegmentation(map), 5), "Segment_5");
  folder.write("map.csv", "damaged");
  EXPECT_EQ(readSegmentation(map).warnings().size(), 2u);
}

TEST(LabelSearch, ColorTableOfSlicersExportIsFound) {
  const TemporaryFolder folder;
  const auto map = folder.write("Segmentation-label.nii", makeLabelMap());
  folder.write("Segmentation-label_ColorTable.ctbl",
               "0 Background 0 0 0 0\n5 Right upper lobe 1 2 3 255\n7 b 4 5 6 255\n");
  EXPECT_EQ(findName(readSegmentation(map), 5), "Right upper lobe");
}

/// A tool that loses the header leaves the position of an array.
TEST(LabelSearch, ALostHeaderGivesAWarning) {
  const TemporaryFolder folder;
  NiftiFile file;
  file.sformCode = 1;
  file.samples[3] = 5;
  file.setSform(Affine(Mat3::Diagonal({-1.0, -1.0, 1.0}), Vec3::Zero()));
  const auto lost = folder.write("lost.nii", file.bytes());
  const Size3 size(3, 4, 2);
  const Affine map(Mat3::Diagonal({2.0, 2.0, 2.0}), {-70.0, -80.0, 5.0});
  const Grid volume(size, map);
  const auto warn = [&](const Grid& grid) { return readSegmentation(lost, &grid).warnings(); };
  ASSERT_EQ(warn(volume).size(), 1u);
  expectMessage(warn(volume)[0], "assumed-geometry");
  EXPECT_TRUE(warn(Grid({4, 4, 2}, map)).empty()) << "another size";
  EXPECT_TRUE(warn(readSegmentation(lost).grid()).empty()) << "the volume is there, too";
}

/// A label map of the volume's size belongs to the volume, whatever the order of its axes.
TEST(LabelSearch, AnotherPositionGivesAWarning) {
  const Affine map(Mat3::Diagonal({2.0, 2.0, 3.0}), {-70.0, -80.0, 5.0});
  const Grid volume({4, 4, 2}, map);
  const auto countWarnings = [&](const Affine& labels, const Size3& size) {
    return checkPosition("labels", Grid(size, labels), volume).size();
  };
  EXPECT_EQ(countWarnings(map, {4, 4, 2}), 0u);
  EXPECT_EQ(
      countWarnings(Affine(Mat3::Diagonal({-2.0, -2.0, 3.0}), {-64.0, -74.0, 5.0}), {4, 4, 2}), 0u);
  EXPECT_EQ(countWarnings(Affine(map.linear(), {-71.0, -80.0, 5.0}), {4, 4, 2}), 1u);
  EXPECT_EQ(countWarnings(Affine(Mat3::Diagonal({2.0, 2.0, 2.0}), map.translation()), {4, 4, 2}),
            1u);
  EXPECT_EQ(countWarnings(Affine(map.linear(), {-71.0, -80.0, 5.0}), {4, 3, 2}), 0u);
}

TEST(LabelSearch, ATableThatContradictsTheFilesOwnNamesGivesAWarning) {
  const TemporaryFolder folder;
  NiftiFile file;
  file.sformCode = 1;
  file.samples[3] = 5;
  const auto map = folder.write("map.nii", file.bytes());
  const auto findWarnings = [&](const std::string& name) {
    folder.write("map.json", R"({"5": ")" + name + "\"}");
    return readSegmentation(map, nullptr, "totalsegmentator2").warnings();
  };
  EXPECT_TRUE(findWarnings("Liver").empty());
  ASSERT_EQ(findWarnings("spleen").size(), 1u);
  expectMessage(findWarnings("spleen")[0], "unmatched-labels | spleen | liver");
}

/// As programs write that give each structure a file.
TEST(LabelSearch, AMaskIsCalledAsItsFile) {
  const TemporaryFolder folder;
  NiftiFile file;
  file.sformCode = 1;
  file.samples[3] = 1;
  const auto mask = folder.write("adrenal_gland_left.nii", file.bytes());
  EXPECT_EQ(findName(readSegmentation(mask), 1), "adrenal_gland_left");
  EXPECT_EQ(readSegmentInfos(mask, {}).at(0).name, "adrenal_gland_left");
  EXPECT_EQ(findName(readSegmentation(folder.write("map.nii", makeLabelMap())), 5), "Segment_5");
  folder.write("adrenal_gland_left.json", R"({"1": "gland"})");
  EXPECT_EQ(findName(readSegmentation(mask), 1), "gland") << "a table precedes";
}

TEST(LabelSearch, SegmentationWithNamesRejectsATable) {
  const TemporaryFolder folder;
  const std::string header =
      "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 1 1 1\nencoding: raw\n"
      "space: left-posterior-superior\nspace directions: (1,0,0) (0,1,0) (0,0,1)\n"
      "space origin: (0,0,0)\nSegment0_ID:=a\nSegment0_LabelValue:=1\n\n\1";
  const auto file = folder.write("s.seg.nrrd", header);
  expectRefused(file, "conflicting-labels", [&] { readSegmentation(file, nullptr, "freesurfer"); });
}

} // namespace
