// Chooses segments by id, name or label value; errors for choices that match none or several.

#include "files/segments/SegmentationReader.h"

#include "MedicalFiles.h"

namespace fenestra::core::SegmentChoiceTests {
namespace {

TEST(SegmentChoice, IdsPrecedeNamesAndNamesPrecedeValues) {
  const TemporaryFolder folder;
  FileGeometry geometry;
  addSegment(geometry, 0, "2", "first", "1", "0");
  addSegment(geometry, 1, "first", "3", "2", "0");
  addSegment(geometry, 2, "c", "twin", "3", "0");
  addSegment(geometry, 3, "d", "twin", "4", "0");
  std::vector<std::uint8_t> labels(24, 0);
  for (std::size_t i = 0; i < 10; ++i) // value n occurs n times
    labels[i] = static_cast<std::uint8_t>(i < 1 ? 1 : i < 3 ? 2 : i < 6 ? 3 : 4);
  writeFile(folder / "s.seg.nrrd", labels, geometry);
  const Segmentation s = readSegmentation(folder / "s.seg.nrrd");
  EXPECT_EQ(s.makeFocusMask({"2"}, s.grid()).count, 1);
  EXPECT_EQ(s.makeFocusMask({"first"}, s.grid()).count, 2);
  EXPECT_EQ(s.makeFocusMask({"3"}, s.grid()).count, 2);
  EXPECT_EQ(s.makeFocusMask({"4"}, s.grid()).count, 4);
  expectRefused(folder / "s.seg.nrrd", "ambiguous-name | c (twin), d (twin)",
                [&] { s.makeFocusMask({"twin"}, s.grid()); });
  expectRefused(folder / "s.seg.nrrd", "unknown-name | spleen | 2 (first)",
                [&] { s.makeFocusMask({"spleen"}, s.grid()); });
}

TEST(SegmentChoice, RefusesEmptyFocusAndListsAtMostTwelveSegments) {
  const TemporaryFolder folder;
  FileGeometry geometry;
  for (int n = 0; n < 60; ++n)
    addSegment(geometry, n, "id" + std::to_string(n), "name\nof two lines", "7", "0");
  writeFile(folder / "s.seg.nrrd", std::vector<std::uint8_t>(24, 1), geometry);
  const Segmentation s = readSegmentation(folder / "s.seg.nrrd");
  expectRefused(folder / "s.seg.nrrd", "empty-focus", [&] { s.makeFocusMask({"id3"}, s.grid()); });
  expectRefused(folder / "s.seg.nrrd", "unknown-name | id11",
                [&] { s.makeFocusMask({"x"}, s.grid()); });
  expectRefused(folder / "s.seg.nrrd", "unknown-name | , …",
                [&] { s.makeFocusMask({"x"}, s.grid()); });
  expectRefused(folder / "s.seg.nrrd", "", [&] { s.makeFocusMask({}, s.grid()); });
}

TEST(SegmentChoice, ErrorSuggestsSimilarSegments) {
  const TemporaryFolder folder;
  FileGeometry geometry;
  addSegment(geometry, 0, "a", "kidney_left", "1", "0");
  addSegment(geometry, 1, "b", "kidney_right", "2", "0");
  addSegment(geometry, 2, "c", "Right Lung", "3", "0");
  writeFile(folder / "s.seg.nrrd", std::vector<std::uint8_t>(24, 1), geometry);
  const Segmentation s = readSegmentation(folder / "s.seg.nrrd");
  const auto expectMessage = [&](const std::string& selector, const std::string& text) {
    expectRefused(folder / "s.seg.nrrd", text, [&] { s.makeFocusMask({selector}, s.grid()); });
  };
  expectMessage("Kidneys", "unknown-name | \"Kidneys\" | kidney_left, kidney_right?");
  expectMessage("left kidney", "unknown-name | mean kidney_left?");
  expectMessage("lung", "unknown-name | Right Lung?");
  expectMessage("spleen", "unknown-name | a (kidney_left), b (kidney_right), c (Right Lung)");
  EXPECT_EQ(s.makeFocusMask({" kidney_left "}, s.grid()).names,
            std::vector<std::string>{"kidney_left"});
}

} // namespace
} // namespace fenestra::core::SegmentChoiceTests
