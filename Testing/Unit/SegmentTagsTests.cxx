// Slicer's segment tags, which can be read without the labels.

#include "files/segments/SegmentationReader.h"

#include "MedicalFiles.h"

namespace fenestra::core::SegmentTagsTests {
namespace {

TEST(SegmentTags, TerminologyIsReadWithoutTheLabels) {
  const TemporaryFolder folder;
  FileGeometry geometry;
  const std::vector<std::string> names = {"left lung", "mass", "no terminology"};
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string segment = "Segment" + std::to_string(i);
    geometry.fields[segment + "_ID"] = std::to_string(i);
    geometry.fields[segment + "_Name"] = names[i];
    geometry.fields[segment + "_LabelValue"] = "1";
    geometry.fields[segment + "_Layer"] = "0";
  }
  geometry.fields["Segment0_Tags"] =
      "Segmentation.Status:inprogress|TerminologyEntry:Segmentation category and type - 3D Slicer "
      "General Anatomy list~SCT^123037004^Anatomical Structure~SCT^39607008^Lung~SCT^7771000^Left~"
      "Anatomic codes - DICOM master list~^^~^^|";
  geometry.fields["Segment1_Tags"] = "Segmentation.TerminologyEntry:L~SCT^49755003^Altered~SCT^"
                                     "4147007^Mass~^^~A~SCT^12738006^Brain~^^";
  geometry.fields["Segment2_Tags"] = "TerminologyEntry:~^|x";
  writeFile(folder / "s.seg.nrrd", std::vector<std::uint8_t>(24, 1), geometry);
  const auto infos = readSegmentInfos(folder / "s.seg.nrrd");
  ASSERT_EQ(infos.size(), 3u);
  EXPECT_EQ(infos[0].name, "left lung");
  EXPECT_EQ(infos[0].type, "SCT^39607008");
  EXPECT_EQ(infos[0].region, "");
  EXPECT_EQ(infos[0].category, "SCT^123037004");
  EXPECT_EQ(infos[1].category, "SCT^49755003");
  EXPECT_EQ(infos[1].type, "SCT^4147007");
  EXPECT_EQ(infos[1].region, "SCT^12738006");
  EXPECT_EQ(infos[2].type, "");
  EXPECT_EQ(infos[2].category, "");
  EXPECT_EQ(readSegmentation(folder / "s.seg.nrrd").segments()[1].region, "SCT^12738006");
  std::vector<std::uint8_t> unnamed(24, 1);
  unnamed[0] = 2;
  writeFile(folder / "labels.nrrd", unnamed);
  EXPECT_TRUE(readSegmentInfos(folder / "labels.nrrd").empty());
  expectRefused(folder / "none.seg.nrrd", "missing-file",
                [&] { readSegmentInfos(folder / "none.seg.nrrd"); });
}

} // namespace
} // namespace fenestra::core::SegmentTagsTests
