// Folders of masks, one structure per file, and probability maps.

#include "files/segments/MaskFolder.h"
#include "files/segments/MaskRuns.h"

#include "MedicalFiles.h"

#include <algorithm>

namespace fenestra::core::MaskFolderTests {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::size_t voxelCount = 24; ///< of FileGeometry's 3 x 4 x 2

Bytes makeMask(const std::vector<std::size_t>& voxels, std::uint8_t value = 1) {
  Bytes mask(voxelCount, 0);
  for (const std::size_t voxel : voxels)
    mask[voxel] = value;
  return mask;
}

std::int64_t count(const Segmentation& segmentation, const std::vector<std::string>& names) {
  return segmentation.makeFocusMask(names, segmentation.grid()).count;
}

std::vector<std::string> listNames(const std::vector<SegmentInfo>& segments) {
  std::vector<std::string> names;
  for (const SegmentInfo& segment : segments)
    names.push_back(segment.name);
  std::ranges::sort(names);
  return names;
}

TEST(MaskFolder, NamesSegmentsByTheirFilesInEveryFormat) {
  const TemporaryFolder folder;
  writeFile(folder / "kidney_left.nii.gz", makeMask({0, 1, 2}));
  writeFile(folder / "liver.nrrd", makeMask({5, 6}, 255));
  writeFile(folder / "spleen.mha", std::vector<float>(voxelCount, 0.0F));
  writeFile(folder / "._liver.nrrd", makeMask({9}));
  folder.write("report.json", "{}");
  const Segmentation s = readSegmentation(folder.path());
  const std::vector<std::string> names = {"kidney_left", "liver", "spleen"};
  EXPECT_EQ(listNames(s.segments()), names);
  EXPECT_EQ(listNames(readSegmentInfos(folder.path())), names);
  EXPECT_EQ(count(s, {"kidney_left"}), 3);
  EXPECT_EQ(count(s, {"liver"}), 2);
  EXPECT_EQ(count(s, {"liver", "spleen", "kidney_left"}), 5);
  EXPECT_EQ(s.statistics()[2].voxels, 0) << "an empty mask is an empty segment";
  EXPECT_TRUE(s.warnings().empty());
  expectRefused(folder.path(), "empty-focus | spleen", [&] { count(s, {"spleen"}); });
  expectRefused(folder.path(), "conflicting-labels",
                [&] { readSegmentation(folder.path(), nullptr, "freesurfer"); });
}

TEST(MaskFolder, MasksOverlap) {
  const TemporaryFolder folder;
  writeFile(folder / "body.nrrd", makeMask({1, 2, 3, 4, 5, 6, 7, 8}));
  writeFile(folder / "liver.nrrd", makeMask({4, 5}));
  writeFile(folder / "tumor.nrrd", makeMask({5, 14}));
  const Segmentation s = readSegmentation(folder.path());
  EXPECT_EQ(count(s, {"body"}), 8);
  EXPECT_EQ(count(s, {"liver"}), 2);
  EXPECT_EQ(count(s, {"tumor"}), 2);
  EXPECT_EQ(count(s, {"liver", "tumor"}), 3);
  EXPECT_EQ(count(s, {"tumor", "body"}), 9);
  EXPECT_NE(s.segments()[0].layer, s.segments()[1].layer);
  std::vector<std::int64_t> voxels;
  for (const SegmentStatistics& one : s.statistics())
    voxels.push_back(one.voxels);
  EXPECT_EQ(voxels, (std::vector<std::int64_t>{8, 2, 2}));
}

TEST(MaskFolder, RestrictsAnOverlappingSegmentOnItsOwnLabelMap) {
  const TemporaryFolder folder;
  writeFile(folder / "a.nrrd", makeMask({0, 1, 2, 3, 4, 5}));
  writeFile(folder / "b.nrrd", makeMask({3, 4, 5, 6, 7}));
  Segmentation s = readSegmentation(folder.path());
  const SegmentInfo b = s.segments()[s.find("b")];
  s.restrictSegment(b, s.makeMask({s.segments()[s.find("a")]}, s.grid()));
  EXPECT_EQ(count(s, {"b"}), 3);
  EXPECT_EQ(count(s, {"a"}), 6);
}

TEST(MaskFolder, GridsDiffer) {
  const TemporaryFolder folder;
  FileGeometry coarse; // 8 x 8 x 8 voxels of 2 mm; the cube of 4 mm in its middle
  coarse.size = {8, 8, 8};
  coarse.spacing = {2, 2, 2};
  Bytes cube(512, 0);
  for (std::size_t i = 0; i < 512; ++i)
    cube[i] = i % 8 / 2 == 1 && i / 8 % 8 / 2 == 1 && i / 64 / 2 == 1;
  writeFile(folder / "cube.nrrd", cube, coarse);
  FileGeometry fine; // 8 x 8 x 8 voxels of 1 mm; the left half
  fine.size = {8, 8, 8};
  Bytes half(512, 0);
  for (std::size_t i = 0; i < 512; ++i)
    half[i] = i % 8 < 4;
  writeFile(folder / "half.nrrd", half, fine);
  const Segmentation s = readSegmentation(folder.path());
  const Grid volume(Size3::Constant(8), Affine(lpsToRas));
  const auto find = [&](const std::vector<std::string>& names) {
    return s.makeFocusMask(names, volume);
  };
  EXPECT_EQ(find({"cube"}).count, 8);
  EXPECT_EQ(find({"half"}).count, 256);
  // Together on the fine lattice: cube, of voxels from 4 to 7 mm, and half do not overlap. Corners
  // of the cube are cut off where its indicator is less than 1/2.
  const Mask both = find({"half", "cube"});
  EXPECT_EQ(both.names, (std::vector<std::string>{"half", "cube"}));
  EXPECT_NEAR(both.grid.spacing().x(), 1.0, 1e-12);
  const auto at = [&](const Vec3& world) {
    return both.contains((both.grid.worldToIndex * world).array().round().cast<std::int64_t>());
  };
  EXPECT_TRUE(at({-5, -5, 5}));
  EXPECT_TRUE(at({-1, -7, 0}));
  EXPECT_FALSE(at({-5, -1, 5}));
}

TEST(MaskFolder, LeavesOutWhatIsNoMaskWithAWarning) {
  const TemporaryFolder folder;
  writeFile(folder / "liver.nrrd", makeMask({5, 6}));
  Bytes scan(voxelCount);
  for (std::size_t i = 0; i < voxelCount; ++i)
    scan[i] = static_cast<std::uint8_t>(i);
  writeFile(folder / "ct.nrrd", scan);
  folder.write("damaged.nii.gz", "no image");
  const Segmentation s = readSegmentation(folder.path());
  EXPECT_EQ(listNames(s.segments()), std::vector<std::string>{"liver"});
  ASSERT_EQ(s.warnings().size(), 2u);
  EXPECT_EQ(s.warnings()[0].subject, (folder / "ct.nrrd").string());
  EXPECT_EQ(s.warnings()[1].subject, (folder / "damaged.nii.gz").string());
  std::filesystem::remove(folder / "liver.nrrd");
  expectRefused(folder.path(), "unsupported-file | ct.nrrd",
                [&] { readSegmentation(folder.path()); });
}

TEST(MaskFolder, RefusesOtherFoldersWithAHint) {
  const TemporaryFolder folder;
  const auto refuse = [&](const std::string& text) {
    expectRefused(folder.path(), "unsupported-file | " + text,
                  [&] { readSegmentation(folder.path()); });
    EXPECT_THROW(readSegmentInfos(folder.path()), Error);
  };
  refuse("one structure per file");
  std::filesystem::create_directory(folder / "segmentations");
  writeFile(folder / "segmentations" / "liver.nrrd", makeMask({5}));
  refuse("give its folder segmentations");
  folder.write("IM0001", std::string(128, '\0') + "DICM");
  refuse("DICOM");
}

TEST(MaskFolder, FilesOfOneNameAreDistinguishedByTheirIds) {
  const TemporaryFolder folder;
  writeFile(folder / "liver.nrrd", makeMask({5}));
  writeFile(folder / "liver.nii.gz", makeMask({6, 7}));
  const Segmentation s = readSegmentation(folder.path());
  EXPECT_EQ(count(s, {"liver.nrrd"}), 1);
  EXPECT_EQ(count(s, {"liver.nii.gz"}), 2);
  expectRefused(folder.path(), "ambiguous-name", [&] { count(s, {"liver"}); });
}

TEST(MaskFolder, MaskIsCroppedToItsBoxAndOneVoxel) {
  const TemporaryFolder folder;
  FileGeometry geometry;
  geometry.size = {40, 30, 20};
  Bytes mask(40 * 30 * 20, 0);
  for (const std::size_t x : {12U, 13U})
    mask[x + 40 * (9 + 30 * 19)] = 1; // in the last slice
  writeFile(folder / "a.nii.gz", mask, geometry);
  const auto [grid, labels] = labelMask(readMask(folder / "a.nii.gz"), 3);
  EXPECT_EQ(grid.size, Size3(4, 3, 2));
  const auto& values = std::get<LargeArray<std::uint8_t>>(labels);
  EXPECT_EQ(values.size(), 24u);
  EXPECT_EQ(std::ranges::count(values, 3), 2);
  EXPECT_EQ(values[linearIndex({1, 1, 1}, grid.size)], 3);
  const Vec3 place = grid.indexToWorld * Vec3(1, 1, 1);
  EXPECT_LT((place - Vec3(-12, -9, 19)).norm(), 1e-6);
}

TEST(MaskFolder, SurfaceOfProbabilitiesIsAtOneHalf) {
  const TemporaryFolder folder;
  std::vector<float> map(voxelCount, 0.0F);
  for (std::size_t i = 0; i < 10; ++i)
    map[i] = 0.1F * static_cast<float>(i + 1);
  map[20] = 0.5F;
  writeFile(folder / "liver_probability.nii.gz", map);
  const Segmentation single = readSegmentation(folder / "liver_probability.nii.gz");
  EXPECT_EQ(count(single, {"1"}), 7);
  EXPECT_EQ(count(single, {"liver_probability"}), 7);
  EXPECT_EQ(count(readSegmentation(folder.path()), {"liver_probability"}), 7);
  map[3] = 1.5F;
  writeFile(folder / "liver_probability.nii.gz", map);
  expectRefused(folder / "liver_probability.nii.gz", "unsupported-file",
                [&] { readSegmentation(folder / "liver_probability.nii.gz"); });
}

} // namespace
} // namespace fenestra::core::MaskFolderTests
