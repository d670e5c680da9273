// Segmentations beside a DICOM series, chosen by the focus or named by the user.

#include "scene/Input.h"

#include "DicomSliceFiles.h"
#include "Refusals.h"

namespace fenestra::core::DicomInputTests {
namespace {

using namespace dicomSlices;

/// A series, and two segmentations of its frame of reference.
class DicomInput : public ::testing::Test {
protected:
  DicomInput() {
    for (int i = 0; i < 3; ++i)
      folder.write(concat("ct", i), makeSlice({.position = Vec3(0, 0, i),
                                               .instance = i,
                                               .more = {makeText(0x00200052, "UI", frame)}}));
    writeSeg(folder / "a", "Liver", frame);
    writeSeg(folder / "b", "Liver mass", frame);
  }

  void writeSeg(const std::filesystem::path& path, const std::string& segment,
                const std::string& uid) const {
    const TemporaryFolder elsewhere;
    const std::filesystem::path file =
        elsewhere.write("s", makeSegFile({.frameOfReference = uid,
                                          .segments = {{1, segment}},
                                          .frames = {{1, 0.0}, {1, 1.0}}}));
    std::filesystem::copy_file(file, path);
  }

  const char* const frame = "1.5";
  const TemporaryFolder folder;
};

TEST_F(DicomInput, FocusChoosesAmongSeveralSegmentations) {
  const Input input(folder.path());
  EXPECT_TRUE(input.hasSeveralSegmentations());
  EXPECT_EQ(input.segmentationFile({.focus = {"Liver mass"}}), (folder / "b").string());
  EXPECT_EQ(input.segments({.focus = {"Liver"}})->segmentation.source(), (folder / "a").string());
  expectRefused(folder.path(), "ambiguous-segmentation",
                [&] { input.segmentationFile({.focus = {"1"}}); });
  expectRefused(folder.path(), "ambiguous-segmentation", [&] { input.segmentationFile({}); });
}

TEST_F(DicomInput, SegmentationOfAnotherFrameOfReferenceWarns) {
  const TemporaryFolder other;
  writeSeg(other / "s", "Liver", "1.6");
  const Input input(folder.path());
  const auto read = [&](const std::filesystem::path& path) {
    return input.segments({.segmentation = path.string()})->segmentation.warnings();
  };
  EXPECT_EQ(read(folder / "a"), std::vector<Message>());
  ASSERT_EQ(read(other / "s").size(), 1U);
  expectMessage(read(other / "s")[0], "assumed-geometry");
}

} // namespace
} // namespace fenestra::core::DicomInputTests
