// Labelmaps and Slicer segmentations, and the masks that become of their segments.

#include "io/SegmentationReader.h"
#include "io/VolumeReader.h"

#include "MedicalFiles.h"

namespace fenestra {
namespace {

Grid unitGrid(const Size3& size, const Vec3& origin = Vec3::Zero(), double spacing = 1.0) {
  Affine map = Affine::Identity();
  map.translate(origin).scale(spacing);
  return {size, map};
}

std::int64_t index(const Grid& grid, std::int64_t x, std::int64_t y, std::int64_t z) {
  return x + grid.size.x() * (y + grid.size.y() * z);
}

int at(const Mask& mask, const Vec3& world) {
  const Vec3 i = mask.grid.worldToIndex * world;
  const Size3 v = i.array().round().cast<std::int64_t>();
  if ((v.array() < 0).any() || (v.array() >= mask.grid.size.array()).any())
    return 0;
  return mask.voxels[static_cast<std::size_t>(index(mask.grid, v.x(), v.y(), v.z()))];
}

/// 6^3 voxels of 1 mm from the origin, with a label here and there.
Segmentation labelmap(const std::vector<std::pair<Size3, int>>& labels, Vec3 origin = Vec3::Zero(),
                      double spacing = 1.0) {
  const Grid grid = unitGrid(Size3::Constant(6), origin, spacing);
  std::vector<std::uint8_t> voxels(216, 0);
  std::vector<SegmentInfo> segments;
  for (const auto& [voxel, label] : labels) {
    voxels[static_cast<std::size_t>(index(grid, voxel.x(), voxel.y(), voxel.z()))] =
        static_cast<std::uint8_t>(label);
    const std::string name = "Segment_" + std::to_string(label);
    segments.push_back({.id = name, .name = name, .labelValue = label});
  }
  return {"test", grid, 1, voxels, segments};
}

TEST(SegmentationReader, cropsToTheExtentPlusAMargin) {
  const Segmentation s = labelmap({{{1, 2, 3}, 1}, {{3, 3, 3}, 2}, {{5, 5, 5}, 3}});
  const Mask mask = s.mask({"1", "2"}, unitGrid({50, 50, 50}, {-20, -20, -20}));
  EXPECT_EQ(mask.grid.size, Size3(5, 4, 3));
  EXPECT_EQ(mask.count, 2);
  EXPECT_EQ(mask.names, (std::vector<std::string>{"Segment_1", "Segment_2"}));
  EXPECT_EQ(mask.voxels.size(), 60u);
  EXPECT_EQ(std::count(mask.voxels.begin(), mask.voxels.end(), 1), 2);
  EXPECT_EQ(at(mask, {1, 2, 3}), 1);
  EXPECT_EQ(at(mask, {3, 3, 3}), 1);
  EXPECT_EQ(at(mask, {5, 5, 5}), 0);
  EXPECT_TRUE((mask.grid.indexToWorld * Vec3::Zero()).isApprox(Vec3(0, 1, 2)));
}

TEST(SegmentationReader, endsWithZerosInsideTheVolume) {
  const Segmentation s = labelmap({{{0, 0, 0}, 1}});
  const Mask mask = s.mask({"1"}, unitGrid({50, 50, 50}, {-20, -20, -20}));
  EXPECT_EQ(mask.grid.size, Size3(3, 3, 3));
  EXPECT_EQ(std::count(mask.voxels.begin(), mask.voxels.end(), 1), 1);
}

TEST(SegmentationReader, continuesOverTheVolumesOwnFaces) {
  const Segmentation s = labelmap({{{0, 0, 5}, 1}, {{1, 0, 5}, 2}});
  // The volume shares the lower faces of x and y, and the upper one of z lies two voxels further
  // in.
  const Mask mask = s.mask({"1", "2"}, unitGrid({8, 12, 8}, {0, 0, 0}, 1.0));
  EXPECT_EQ(mask.count, 2);
  EXPECT_EQ(at(mask, {-1, 0, 5}), 1);
  EXPECT_EQ(at(mask, {0, -1, 5}), 1);
  EXPECT_EQ(at(mask, {-1, -1, 5}), 1);
  EXPECT_EQ(at(mask, {0, 0, 6}), 0);
  EXPECT_EQ(at(mask, {-1, -1, 6}), 0);
  const Mask whole = s.mask({"1", "2"}, unitGrid({6, 6, 6}));
  EXPECT_EQ(at(whole, {0, 0, 6}), 1);
  EXPECT_EQ(whole.count, 2);
}

TEST(SegmentationReader, sharesFacesWithinHalfAVoxelOnly) {
  const Segmentation s = labelmap({{{0, 3, 3}, 1}});
  const auto continued = [&s](double offset, double spacing = 1.0) {
    return at(s.mask({"1"}, unitGrid({9, 9, 9}, {offset, -3, -3}, spacing)), {-1, 3, 3}) == 1;
  };
  EXPECT_TRUE(continued(0.0));
  EXPECT_TRUE(continued(0.45));
  EXPECT_TRUE(continued(-0.45));
  EXPECT_FALSE(continued(0.6));
  EXPECT_FALSE(continued(-0.6));
  EXPECT_TRUE(continued(0.5, 2.0)); // faces at -0.5 and -0.5
  // A labelmap that abuts the volume from outside shares nothing.
  EXPECT_EQ(at(s.mask({"1"}, unitGrid({6, 9, 9}, {-6, -3, -3})), {-1, 3, 3}), 0);
}

TEST(SegmentationReader, sharesFacesOfFlippedAndTurnedGrids) {
  const Segmentation s = labelmap({{{0, 3, 3}, 1}});
  Affine flipped = Affine::Identity(); // fills the same box as the labelmap, axes permuted
  flipped.linear() << 0, 0, -1, 1, 0, 0, 0, -1, 0;
  flipped.translation() = Vec3(5, 0, 5);
  EXPECT_EQ(at(s.mask({"1"}, Grid({6, 6, 6}, flipped)), {-1, 3, 3}), 1);
  Affine oblique = Affine::Identity();
  oblique.rotate(Eigen::AngleAxisd(0.4, Vec3::UnitZ()));
  EXPECT_EQ(at(s.mask({"1"}, Grid({6, 6, 6}, oblique)), {-1, 3, 3}), 0);
}

TEST(SegmentationReader, readsPlainLabelmapsOfEveryFormat) {
  const TemporaryFolder folder;
  std::vector<std::int16_t> labels(24, 0);
  labels[5] = 300;
  labels[6] = -2;
  std::vector<float> floats(labels.begin(), labels.end());
  for (const char* name : {"s.nrrd", "s.nii.gz", "s.mha"})
    for (const bool real : {false, true}) {
      if (real)
        writeFile(folder / name, floats);
      else
        writeFile(folder / name, labels);
      const Segmentation s = readSegmentation(folder / name);
      ASSERT_EQ(s.segments().size(), 2u) << name;
      EXPECT_EQ(s.segments()[0].id, "Segment_-2");
      EXPECT_EQ(s.segments()[1].name, "Segment_300");
      EXPECT_EQ(s.mask({"300"}, s.grid()).count, 1);
      EXPECT_EQ(s.mask({"-2", "Segment_300"}, s.grid()).count, 2);
    }
}

/// Slicer's fields for segment n.
void describe(FileGeometry& geometry, int n, const std::string& id, const std::string& name,
              const std::string& value, const std::string& layer) {
  const std::string prefix = "Segment" + std::to_string(n) + "_";
  geometry.fields[prefix + "ID"] = id;
  geometry.fields[prefix + "Name"] = name;
  geometry.fields[prefix + "Color"] = "0.5 0.25 1";
  geometry.fields[prefix + "LabelValue"] = value;
  if (!layer.empty())
    geometry.fields[prefix + "Layer"] = layer;
}

TEST(SegmentationReader, readsOneLayerWhoseSegmentsDoNotSayWhich) {
  const TemporaryFolder folder;
  FileGeometry geometry;
  describe(geometry, 0, "a", "liver", "1", "");
  describe(geometry, 1, "b", "tumour", "2", "");
  std::vector<std::uint8_t> labels(24, 0);
  labels[3] = 1;
  labels[7] = labels[8] = 2;
  writeFile(folder / "s.seg.nrrd", labels, geometry);
  const Segmentation s = readSegmentation(folder / "s.seg.nrrd");
  EXPECT_EQ(s.mask({"liver"}, s.grid()).count, 1);
  EXPECT_EQ(s.mask({"tumour"}, s.grid()).count, 2);
}

TEST(SegmentationReader, readsLayersThatOverlap) {
  const TemporaryFolder folder;
  for (const bool old : {false, true}) { // older files have no Layer
    FileGeometry geometry{.components = 2, .compress = true};
    describe(geometry, 0, "a", "liver", "1", old ? "" : "0");
    describe(geometry, 1, "b", "tumour", "1", old ? "" : "1");
    std::vector<std::uint8_t> labels(48, 0);
    for (const std::size_t voxel : {3u, 4u, 5u})
      labels[2 * voxel] = 1;
    for (const std::size_t voxel : {5u, 8u})
      labels[2 * voxel + 1] = 1;
    writeFile(folder / "s.seg.nrrd", labels, geometry);
    const Segmentation s = readSegmentation(folder / "s.seg.nrrd");
    ASSERT_EQ(s.segments().size(), 2u);
    EXPECT_EQ(s.segments()[1].layer, 1u);
    EXPECT_TRUE((s.segments()[0].color == Rgb(0.5, 0.25, 1)).all());
    EXPECT_EQ(s.mask({"liver"}, s.grid()).count, 3);
    EXPECT_EQ(s.mask({"b"}, s.grid()).count, 2);
    EXPECT_EQ(s.mask({"a", "tumour"}, s.grid()).count, 4);
    expectRefused(folder / "s.seg.nrrd", "a (liver), b (tumour)", [&] { s.mask({"1"}, s.grid()); });
  }
}

TEST(SegmentationReader, prefersIdsToNamesToValues) {
  const TemporaryFolder folder;
  FileGeometry geometry;
  describe(geometry, 0, "2", "first", "1", "0");
  describe(geometry, 1, "first", "3", "2", "0");
  describe(geometry, 2, "c", "twin", "3", "0");
  describe(geometry, 3, "d", "twin", "4", "0");
  std::vector<std::uint8_t> labels(24, 0);
  for (std::size_t i = 0; i < 10; ++i) // 1 once, 2 twice, 3 three times, 4 four times
    labels[i] = static_cast<std::uint8_t>(i < 1 ? 1 : i < 3 ? 2 : i < 6 ? 3 : 4);
  writeFile(folder / "s.seg.nrrd", labels, geometry);
  const Segmentation s = readSegmentation(folder / "s.seg.nrrd");
  EXPECT_EQ(s.mask({"2"}, s.grid()).count, 1);
  EXPECT_EQ(s.mask({"first"}, s.grid()).count, 2);
  EXPECT_EQ(s.mask({"3"}, s.grid()).count, 2);
  EXPECT_EQ(s.mask({"4"}, s.grid()).count, 4);
  expectRefused(folder / "s.seg.nrrd", "c (twin), d (twin)", [&] { s.mask({"twin"}, s.grid()); });
  expectRefused(folder / "s.seg.nrrd", "has no segment \"spleen\"; it has 2 (first)",
                [&] { s.mask({"spleen"}, s.grid()); });
}

TEST(SegmentationReader, refusesEmptyFocusAndListsNoMoreThanForty) {
  const TemporaryFolder folder;
  FileGeometry geometry;
  for (int n = 0; n < 60; ++n)
    describe(geometry, n, "id" + std::to_string(n), "name\nof two lines", "7", "0");
  writeFile(folder / "s.seg.nrrd", std::vector<std::uint8_t>(24, 1), geometry);
  const Segmentation s = readSegmentation(folder / "s.seg.nrrd");
  expectRefused(folder / "s.seg.nrrd", "the focus has no voxel",
                [&] { s.mask({"id3"}, s.grid()); });
  expectRefused(folder / "s.seg.nrrd", "id39", [&] { s.mask({"x"}, s.grid()); });
  expectRefused(folder / "s.seg.nrrd", ", …", [&] { s.mask({"x"}, s.grid()); });
  expectRefused(folder / "s.seg.nrrd", "", [&] { s.mask({}, s.grid()); });
}

TEST(SegmentationReader, refusesWhatIsNoSegmentation) {
  const TemporaryFolder folder;
  const auto refuse = [&folder](const std::string& text) {
    expectRefused(folder / "s.nrrd", text, [&] { readSegmentation(folder / "s.nrrd"); });
  };
  refuse("no such file");
  std::vector<float> fraction(24, 0.0f);
  fraction[3] = 0.5f;
  writeFile(folder / "s.nrrd", fraction);
  refuse("whole numbers");
  fraction[3] = std::numeric_limits<float>::quiet_NaN();
  writeFile(folder / "s.nrrd", fraction);
  refuse("whole numbers");
  fraction[3] = 2147483648.0f;
  writeFile(folder / "s.nrrd", fraction);
  refuse("32 bits");
  writeFile(folder / "s.nrrd", std::vector<std::uint8_t>(72, 1), {.components = 3});
  refuse("names no segments");
  FileGeometry geometry;
  describe(geometry, 0, "a", "a", "1", "1");
  writeFile(folder / "s.nrrd", std::vector<std::uint8_t>(24, 1), geometry);
  refuse("Segment0_Layer");
  geometry.fields["Segment0_Layer"] = "0";
  geometry.fields["Segment0_LabelValue"] = "one";
  writeFile(folder / "s.nrrd", std::vector<std::uint8_t>(24, 1), geometry);
  refuse("Segment0_LabelValue");
}

// ---- real data
// -----------------------------------------------------------------------------------

std::filesystem::path data(const std::string& name) {
  return std::filesystem::path(FENESTRA_DATA) / name;
}

TEST(SegmentationReader, readsRealSegmentations) {
  if (!std::filesystem::exists(data("slicerio_segnrrd")))
    GTEST_SKIP() << "no real data at " << FENESTRA_DATA;
  const Grid chest = readVolume(data("slicerio_segnrrd/CTChest4.nrrd")).grid;
  const Segmentation single = readSegmentation(data("slicerio_segnrrd/Segmentation.seg.nrrd"));
  EXPECT_EQ(single.segments().size(), 7u);
  EXPECT_GT(single.mask({"ribs"}, chest).count, 1000);
  const Segmentation layered =
      readSegmentation(data("slicerio_segnrrd/SegmentationOverlapping.seg.nrrd"));
  ASSERT_EQ(layered.segments().size(), 8u);
  EXPECT_EQ(layered.mask({"ribs"}, chest).count, single.mask({"ribs"}, chest).count);
  const auto inSecondLayer = std::count_if(layered.segments().begin(), layered.segments().end(),
                                           [](const SegmentInfo& s) { return s.layer == 1; });
  EXPECT_GE(inSecondLayer, 1);
  for (const SegmentInfo& s : layered.segments())
    EXPECT_GT(layered.mask({s.id}, chest).count, 0) << s.name;
  const Segmentation knee = readSegmentation(data("spl_knee_atlas_labels/seg.nrrd"));
  EXPECT_EQ(knee.segments().size(), 49u);
  EXPECT_GT(knee.mask({knee.segments()[0].id}, knee.grid()).count, 0);
  const Segmentation legacy = readSegmentation(
      data("slicer_scenes/slicerrt_scenes/EclipseProstate_Expanded_5_5_5_Bladder.seg.nrrd"));
  EXPECT_EQ(legacy.segments().at(0).name, "Expanded_5_5_5_Bladder");
  EXPECT_GT(legacy.mask({"Expanded_5_5_5_Bladder"}, legacy.grid()).count, 1000);
}

} // namespace
} // namespace fenestra
