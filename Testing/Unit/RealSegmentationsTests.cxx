// Segmentations of real patients, if the data are present.

#include "files/medical/VolumeReader.h"
#include "files/segments/SegmentationReader.h"

#include <gtest/gtest.h>

namespace fenestra::core::RealSegmentationsTests {
namespace {

std::filesystem::path findData(const std::string& name) {
  return std::filesystem::path(FENESTRA_DATA) / name;
}

TEST(RealSegmentations, ReadsSegmentsAndLayers) {
  if (!std::filesystem::exists(findData("slicerio_segnrrd")))
    GTEST_SKIP() << "no real data at " << FENESTRA_DATA;
  const Grid chest = readVolume(findData("slicerio_segnrrd/CTChest4.nrrd")).grid;
  const Segmentation single = readSegmentation(findData("slicerio_segnrrd/Segmentation.seg.nrrd"));
  EXPECT_EQ(single.segments().size(), 7u);
  EXPECT_GT(single.makeFocusMask({"ribs"}, chest).count, 1000);
  const Segmentation layered =
      readSegmentation(findData("slicerio_segnrrd/SegmentationOverlapping.seg.nrrd"));
  ASSERT_EQ(layered.segments().size(), 8u);
  EXPECT_EQ(layered.makeFocusMask({"ribs"}, chest).count,
            single.makeFocusMask({"ribs"}, chest).count);
  const auto inSecondLayer = std::count_if(layered.segments().begin(), layered.segments().end(),
                                           [](const SegmentInfo& s) { return s.layer == 1; });
  EXPECT_GE(inSecondLayer, 1);
  for (const SegmentInfo& s : layered.segments())
    EXPECT_GT(layered.makeFocusMask({s.id}, chest).count, 0) << s.name;
  const Segmentation knee = readSegmentation(findData("spl_knee_atlas_labels/seg.nrrd"));
  EXPECT_EQ(knee.segments().size(), 49u);
  EXPECT_GT(knee.makeFocusMask({knee.segments()[0].id}, knee.grid()).count, 0);
  const Segmentation legacy = readSegmentation(
      findData("slicer_scenes/slicerrt_scenes/EclipseProstate_Expanded_5_5_5_Bladder.seg.nrrd"));
  EXPECT_EQ(legacy.segments().at(0).name, "Expanded_5_5_5_Bladder");
  EXPECT_EQ(legacy.makeFocusMask({"Expanded_5_5_5_Bladder"}, legacy.grid()).count, 84024);
}

/// Compares files of the oldest format with surfaces of the same patient, in RAS, from
/// EclipseProstate_Structures.seg: the bladder plus 5 mm, and its union with the target volume.
TEST(RealSegmentations, OldFormatMatchesSurfacesOfPatient) {
  const std::filesystem::path folder = findData("slicer_scenes/slicerrt_scenes");
  if (!std::filesystem::exists(folder))
    GTEST_SKIP() << "no real data at " << FENESTRA_DATA;
  const Box bladder{Vec3(-24.8, -16.8, -60.0), Vec3(31.3, 55.6, -10.0)};
  const Box target{Vec3(-19.9, -29.8, -97.5), Vec3(26.0, 22.9, -50.0)};
  const auto expectBounds = [&](const char* file, const Vec3& lower, const Vec3& upper) {
    const Box found = readSegmentation(folder / file).statistics().at(0).bounds;
    const Vec3 voxel(1.0, 1.0, 2.5);
    EXPECT_TRUE(((found.lower - lower).cwiseAbs().array() <= voxel.array()).all())
        << file << ": " << found.lower;
    EXPECT_TRUE(((found.upper - upper).cwiseAbs().array() <= voxel.array()).all())
        << file << ": " << found.upper;
  };
  expectBounds("EclipseProstate_Expanded_5_5_5_Bladder.seg.nrrd",
               bladder.lower - Vec3::Constant(5.0), bladder.upper + Vec3::Constant(5.0));
  expectBounds("EclipseProstate_Bladder_Union_PTV.seg.nrrd", bladder.lower.cwiseMin(target.lower),
               bladder.upper.cwiseMax(target.upper));
}

} // namespace
} // namespace fenestra::core::RealSegmentationsTests
