// Labelmaps and Slicer segmentations, and focus masks of their segments.

#include "files/medical/VolumeReader.h"
#include "files/segments/SegmentationReader.h"

#include "Approx.h"
#include "MedicalFiles.h"

namespace fenestra::core::SegmentationReaderTests {
namespace {

Grid makeGrid(const Size3& size, const Vec3& origin = Vec3::Zero(), double spacing = 1.0) {
  return {size, makeTranslation(origin) * makeScaling(Vec3::Constant(spacing))};
}

std::int64_t toIndex(const Grid& grid, std::int64_t x, std::int64_t y, std::int64_t z) {
  return x + grid.size.x() * (y + grid.size.y() * z);
}

int getVoxel(const Mask& mask, const Vec3& world) {
  const Vec3 i = mask.grid.worldToIndex * world;
  const Size3 v = i.array().round().cast<std::int64_t>();
  if ((v.array() < 0).any() || (v.array() >= mask.grid.size.array()).any())
    return 0;
  return mask.voxels[static_cast<std::size_t>(toIndex(mask.grid, v.x(), v.y(), v.z()))];
}

/// Labelmap of 6^3 voxels of `spacing` mm with some labels.
Segmentation makeLabelmap(const std::vector<std::pair<Size3, int>>& labels,
                          Vec3 origin = Vec3::Zero(), double spacing = 1.0) {
  const Grid grid = makeGrid(Size3::Constant(6), origin, spacing);
  LargeArray<std::uint8_t> voxels(216, 0);
  std::vector<SegmentInfo> segments;
  for (const auto& [voxel, label] : labels) {
    voxels[static_cast<std::size_t>(toIndex(grid, voxel.x(), voxel.y(), voxel.z()))] =
        static_cast<std::uint8_t>(label);
    const std::string name = "Segment_" + std::to_string(label);
    segments.push_back({.id = name, .name = name, .labelValue = label});
  }
  return {"test", grid, 1, voxels, segments};
}

TEST(SegmentationReader, MaskIsCroppedToTheSegmentsPlusAMargin) {
  const Segmentation s = makeLabelmap({{{1, 2, 3}, 1}, {{3, 3, 3}, 2}, {{5, 5, 5}, 3}});
  const Mask mask = s.makeFocusMask({"1", "2"}, makeGrid({50, 50, 50}, {-20, -20, -20}));
  EXPECT_EQ(mask.grid.size, Size3(5, 4, 3));
  EXPECT_EQ(mask.count, 2);
  EXPECT_EQ(mask.names, (std::vector<std::string>{"Segment_1", "Segment_2"}));
  EXPECT_EQ(mask.voxels.size(), 60u);
  EXPECT_EQ(std::count(mask.voxels.begin(), mask.voxels.end(), 1), 2);
  EXPECT_EQ(getVoxel(mask, {1, 2, 3}), 1);
  EXPECT_EQ(getVoxel(mask, {3, 3, 3}), 1);
  EXPECT_EQ(getVoxel(mask, {5, 5, 5}), 0);
  EXPECT_TRUE(isApprox(mask.grid.indexToWorld * Vec3::Zero(), Vec3(0, 1, 2)));
}

TEST(SegmentationReader, MaskHasAMarginOfZerosInsideTheVolume) {
  const Segmentation s = makeLabelmap({{{0, 0, 0}, 1}});
  const Mask mask = s.makeFocusMask({"1"}, makeGrid({50, 50, 50}, {-20, -20, -20}));
  EXPECT_EQ(mask.grid.size, Size3(3, 3, 3));
  EXPECT_EQ(std::count(mask.voxels.begin(), mask.voxels.end(), 1), 1);
}

TEST(SegmentationReader, MaskIsExtendedBeyondFacesOfTheVolume) {
  const Segmentation s = makeLabelmap({{{0, 0, 5}, 1}, {{1, 0, 5}, 2}});
  // The labelmap's lower x and y faces are faces of the volume; its upper z face is two voxels
  // inside it.
  const Mask mask = s.makeFocusMask({"1", "2"}, makeGrid({8, 12, 8}, {0, 0, 0}, 1.0));
  EXPECT_EQ(mask.count, 2);
  EXPECT_EQ(getVoxel(mask, {-1, 0, 5}), 1);
  EXPECT_EQ(getVoxel(mask, {0, -1, 5}), 1);
  EXPECT_EQ(getVoxel(mask, {-1, -1, 5}), 1);
  EXPECT_EQ(getVoxel(mask, {0, 0, 6}), 0);
  EXPECT_EQ(getVoxel(mask, {-1, -1, 6}), 0);
  const Mask full = s.makeFocusMask({"1", "2"}, makeGrid({6, 6, 6}));
  EXPECT_EQ(getVoxel(full, {0, 0, 6}), 1);
  EXPECT_EQ(full.count, 2);
}

TEST(SegmentationReader, FacesWithinHalfAVoxelCoincide) {
  const Segmentation s = makeLabelmap({{{0, 3, 3}, 1}});
  const auto isExtended = [&s](double offset, double spacing = 1.0) {
    return getVoxel(s.makeFocusMask({"1"}, makeGrid({9, 9, 9}, {offset, -3, -3}, spacing)),
                    {-1, 3, 3}) == 1;
  };
  EXPECT_TRUE(isExtended(0.0));
  EXPECT_TRUE(isExtended(0.45));
  EXPECT_TRUE(isExtended(-0.45));
  EXPECT_FALSE(isExtended(0.6));
  EXPECT_FALSE(isExtended(-0.6));
  EXPECT_TRUE(isExtended(0.5, 2.0)); // both faces at -0.5
  // A labelmap that touches the volume from outside has no coinciding face.
  EXPECT_EQ(getVoxel(s.makeFocusMask({"1"}, makeGrid({6, 9, 9}, {-6, -3, -3})), {-1, 3, 3}), 0);
}

TEST(SegmentationReader, FacesOfFlippedGridsCoincideButNotOfObliqueOnes) {
  const Segmentation s = makeLabelmap({{{0, 3, 3}, 1}});
  // Grid of the labelmap's box with permuted axes.
  const Affine flipped(Mat3({0, 1, 0}, {0, 0, -1}, {-1, 0, 0}), {5, 0, 5});
  EXPECT_EQ(getVoxel(s.makeFocusMask({"1"}, Grid({6, 6, 6}, flipped)), {-1, 3, 3}), 1);
  const Affine oblique = makeRotation(0.4, Vec3::UnitZ());
  EXPECT_EQ(getVoxel(s.makeFocusMask({"1"}, Grid({6, 6, 6}, oblique)), {-1, 3, 3}), 0);
}

TEST(SegmentationReader, ReadsPlainLabelmapsInEveryFormat) {
  const TemporaryFolder folder;
  std::vector<std::int16_t> labels(24, 0);
  labels[5] = 300;
  labels[6] = -2;
  std::vector<float> floats(labels.begin(), labels.end());
  for (const char* name : {"s.nrrd", "s.nii.gz", "s.mha"})
    for (const bool isFloat : {false, true}) {
      if (isFloat)
        writeFile(folder / name, floats);
      else
        writeFile(folder / name, labels);
      const Segmentation s = readSegmentation(folder / name);
      ASSERT_EQ(s.segments().size(), 2u) << name;
      EXPECT_EQ(s.segments()[0].id, "Segment_-2");
      EXPECT_EQ(s.segments()[1].name, "Segment_300");
      EXPECT_EQ(s.makeFocusMask({"300"}, s.grid()).count, 1);
      EXPECT_EQ(s.makeFocusMask({"-2", "Segment_300"}, s.grid()).count, 2);
    }
}

TEST(SegmentationReader, ReadsOneLayerWithoutLayerField) {
  const TemporaryFolder folder;
  FileGeometry geometry;
  addSegment(geometry, 0, "a", "liver", "1", "");
  addSegment(geometry, 1, "b", "tumor", "2", "");
  std::vector<std::uint8_t> labels(24, 0);
  labels[3] = 1;
  labels[7] = labels[8] = 2;
  writeFile(folder / "s.seg.nrrd", labels, geometry);
  const Segmentation s = readSegmentation(folder / "s.seg.nrrd");
  EXPECT_EQ(s.makeFocusMask({"liver"}, s.grid()).count, 1);
  EXPECT_EQ(s.makeFocusMask({"tumor"}, s.grid()).count, 2);
}

TEST(SegmentationReader, ReadsOverlappingLayers) {
  const TemporaryFolder folder;
  for (const bool isOld : {false, true}) { // older files have no Layer field
    FileGeometry geometry{.components = 2, .compress = true};
    addSegment(geometry, 0, "a", "liver", "1", isOld ? "" : "0");
    addSegment(geometry, 1, "b", "tumor", "1", isOld ? "" : "1");
    std::vector<std::uint8_t> labels(48, 0);
    for (const std::size_t voxel : {3u, 4u, 5u})
      labels[2 * voxel] = 1;
    for (const std::size_t voxel : {5u, 8u})
      labels[2 * voxel + 1] = 1;
    writeFile(folder / "s.seg.nrrd", labels, geometry);
    const Segmentation s = readSegmentation(folder / "s.seg.nrrd");
    ASSERT_EQ(s.segments().size(), 2u);
    EXPECT_EQ(s.segments()[1].layer, 1u);
    EXPECT_TRUE(s.segments()[0].color == Rgb(0.5, 0.25, 1));
    EXPECT_EQ(s.makeFocusMask({"liver"}, s.grid()).count, 3);
    EXPECT_EQ(s.makeFocusMask({"b"}, s.grid()).count, 2);
    EXPECT_EQ(s.makeFocusMask({"a", "tumor"}, s.grid()).count, 4);
    expectRefused(folder / "s.seg.nrrd", "ambiguous-name | a (liver), b (tumor)",
                  [&] { s.makeFocusMask({"1"}, s.grid()); });
  }
}

/// MITK lists its labels in JSON, in one group per layer.
class MitkLabels : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Keys, MitkLabels,
                         ::testing::Values("org_mitk_multilabel_segmentation_labelgroups",
                                           "org.mitk.multilabel.segmentation.labelgroups"));

TEST_P(MitkLabels, AreReadFromTheirGroups) {
  const TemporaryFolder folder;
  const char* const key = GetParam();
  FileGeometry geometry{.components = 2};
  geometry.fields[key] = R"([{"labels": [{"name": "liver", "value": 1,
      "color": {"type": "ColorProperty", "value": [0.5, 0.25, 1]}}, {"name": "cyst", "value": 2}]},
      {"labels": [{"name": "vessel", "value": 1}]}])";
  std::erase(geometry.fields[key], '\n');
  std::vector<std::uint8_t> samples(48, 0);
  samples[0] = samples[1] = 1; // both layers of the first voxel
  samples[2] = 2;
  samples[3] = 1; // the second layer of the second voxel
  const auto path = folder / "labels.nrrd";
  writeFile(path, samples, geometry);
  const Segmentation segmentation = readSegmentation(path);
  ASSERT_EQ(segmentation.segments().size(), 3U);
  EXPECT_NEAR(segmentation.segments()[0].color[1], 0.25, 1e-12);
  for (const auto& [name, count] :
       {std::pair("liver", 1), std::pair("cyst", 1), std::pair("vessel", 2)})
    EXPECT_EQ(segmentation.makeFocusMask({name}, segmentation.grid()).count, count) << name;
  for (const char* damaged :
       {"[{", R"([{"labels": [{"name": "a", "value": 0}]}])", R"([{"names": []}])",
        R"([{"labels": []}, {"labels": []}, {"labels": []}])"}) {
    geometry.fields[key] = damaged;
    writeFile(path, samples, geometry);
    EXPECT_THROW(readSegmentation(path), Error) << damaged;
  }
}

TEST(SegmentationReader, RefusesFilesThatAreNotSegmentations) {
  const TemporaryFolder folder;
  const auto refuse = [&folder](const std::string& text) {
    expectRefused(folder / "s.nrrd", text, [&] { readSegmentation(folder / "s.nrrd"); });
  };
  refuse("missing-file");
  std::vector<float> fraction(24, 0.0f);
  fraction[3] = 1.5f;
  writeFile(folder / "s.nrrd", fraction);
  refuse("unsupported-file");
  fraction[3] = std::numeric_limits<float>::quiet_NaN();
  writeFile(folder / "s.nrrd", fraction);
  refuse("unsupported-file");
  fraction[3] = 2147483648.0f;
  writeFile(folder / "s.nrrd", fraction);
  refuse("limit-exceeded");
  writeFile(folder / "s.nrrd", std::vector<std::uint8_t>(72, 1), {.components = 3});
  refuse("unsupported-file");
  FileGeometry geometry;
  addSegment(geometry, 0, "a", "a", "1", "1");
  writeFile(folder / "s.nrrd", std::vector<std::uint8_t>(24, 1), geometry);
  refuse("invalid-field: Segment0_Layer");
  geometry.fields["Segment0_Layer"] = "0";
  geometry.fields["Segment0_LabelValue"] = "one";
  writeFile(folder / "s.nrrd", std::vector<std::uint8_t>(24, 1), geometry);
  refuse("invalid-field: Segment0_LabelValue");
}

// ---- variants in Slicer's files

/// Center of a segment's voxels in world space.
Vec3 computeCentroid(const Segmentation& segmentation, const std::string& selector) {
  const Grid distantGrid = makeGrid({1, 1, 1}, Vec3::Constant(1e6)); // no coinciding face
  const Mask mask = segmentation.makeFocusMask({selector}, distantGrid);
  Vec3 sum = Vec3::Zero();
  for (std::int64_t z = 0; z < mask.grid.size.z(); ++z)
    for (std::int64_t y = 0; y < mask.grid.size.y(); ++y)
      for (std::int64_t x = 0; x < mask.grid.size.x(); ++x)
        if (mask.voxels[static_cast<std::size_t>(toIndex(mask.grid, x, y, z))] != 0)
          sum += mask.grid.indexToWorld * Size3(x, y, z).cast<double>();
  return sum / static_cast<double>(mask.count);
}

TEST(SegmentationReader, OriginOfACroppedFileAlreadyIncludesTheOffset) {
  const TemporaryFolder folder;
  FileGeometry geometry{.spacing = {2, 3, 4}, .origin = {10, 20, 30}};
  addSegment(geometry, 0, "a", "liver", "1", "0");
  geometry.fields["Segmentation_ReferenceImageExtentOffset"] = "5 6 7";
  geometry.fields["Segment0_Extent"] = "0 2 0 3 0 1";
  std::vector<std::uint8_t> labels(24, 0);
  labels[1] = 1; // voxel 1 0 0
  writeFile(folder / "s.seg.nrrd", labels, geometry);
  const Segmentation s = readSegmentation(folder / "s.seg.nrrd");
  EXPECT_TRUE(isApprox(computeCentroid(s, "liver"), Vec3(-12, -20, 30)));
}

TEST(SegmentationReader, IgnoresTheExtentFieldOfSegments) {
  const TemporaryFolder folder;
  FileGeometry geometry;
  addSegment(geometry, 0, "a", "liver", "1", "0");
  std::vector<std::uint8_t> labels(24, 0);
  labels[0] = labels[11] = labels[23] = 1;
  for (const char* extent : {"1 1 1 1 1 1", "0 -1 0 -1 0 -1", "-9 99 -9 99 -9 99", "nonsense"}) {
    geometry.fields["Segment0_Extent"] = extent;
    writeFile(folder / "s.seg.nrrd", labels, geometry);
    const Segmentation s = readSegmentation(folder / "s.seg.nrrd");
    EXPECT_EQ(s.makeFocusMask({"a"}, s.grid()).count, 3) << extent;
  }
}

TEST(SegmentationReader, IgnoresLabelValuesWithoutSegment) {
  const TemporaryFolder folder;
  FileGeometry geometry{.components = 2};
  addSegment(geometry, 0, "a", "liver", "7", "0");
  addSegment(geometry, 1, "b", "tumor", "300", "1");
  std::vector<std::int16_t> labels(48, 0);
  labels[0] = labels[2] = 7;      // liver
  labels[4] = 5;                  // not a segment's value
  labels[6] = 300;                // tumor's value, but in liver's layer
  labels[1] = 7;                  // liver's value, but in tumor's layer
  labels[5] = labels[9] = 300;    // tumor
  labels[11] = labels[13] = -300; // not a segment's value
  writeFile(folder / "s.seg.nrrd", labels, geometry);
  const Segmentation s = readSegmentation(folder / "s.seg.nrrd");
  EXPECT_EQ(s.makeFocusMask({"liver"}, s.grid()).count, 2);
  EXPECT_EQ(s.makeFocusMask({"300"}, s.grid()).count, 2);
  EXPECT_EQ(s.makeFocusMask({"a", "b"}, s.grid()).count, 4);
  expectRefused(folder / "s.seg.nrrd", "unknown-name | 5",
                [&] { s.makeFocusMask({"5"}, s.grid()); });
  const auto statistics = s.statistics();
  EXPECT_EQ(statistics[0].voxels, 2);
  EXPECT_EQ(statistics[1].voxels, 2);
}

TEST(SegmentationReader, ReadsOldColorsAndReplacesInvalidOnes) {
  const TemporaryFolder folder;
  FileGeometry geometry;
  for (int n = 0; n < 6; ++n)
    addSegment(geometry, n, std::string(1, static_cast<char>('a' + n)), "s", std::to_string(n + 1),
               "0");
  const std::array colors = {"0.1 0.2 0.3", "red", "0.5 0.5", "2 0 0", "nan 0 0", "0 0 0"};
  for (std::size_t n = 0; n < 6; ++n) {
    const std::string prefix = std::string("Segment") + std::to_string(n);
    geometry.fields[prefix + "_DefaultColor"] = colors[n];
    if (n < 5) // the last also has a Color field, which takes precedence
      geometry.fields.erase(prefix + "_Color");
  }
  writeFile(folder / "s.seg.nrrd", std::vector<std::uint8_t>(24, 1), geometry);
  const Segmentation s = readSegmentation(folder / "s.seg.nrrd");
  EXPECT_TRUE(s.segments()[0].color == Rgb(0.1, 0.2, 0.3));
  for (std::size_t n = 1; n < 5; ++n)
    EXPECT_TRUE(s.segments()[n].color == Rgb::Constant(0.5)) << n;
  EXPECT_TRUE(s.segments()[5].color == Rgb(0.5, 0.25, 1));
}

TEST(SegmentationReader, IgnoresOtherFieldsWrittenBySlicer) {
  const TemporaryFolder folder;
  FileGeometry geometry;
  addSegment(geometry, 0, "a", "left lung | upper: lobe; \"A\" = 1", "1", "0");
  geometry.fields["Segment0_Tags"] =
      "Segmentation.Status:inprogress|TerminologyEntry:General Anatomy list~SCT^1^Lung~SCT^2^Left|";
  geometry.fields["Segment0_NameAutoGenerated"] = "1";
  geometry.fields["Segment0_ColorAutoGenerated"] = "maybe";
  geometry.fields["Segmentation_MasterRepresentation"] = "Binary labelmap";
  geometry.fields["Segmentation_ContainedRepresentationNames"] = "Binary labelmap|Closed surface|";
  geometry.fields["Segmentation_ConversionParameters"] =
      "Decimation factor|0.0|Desired reduction: 0.0 (none) to 1.0&Reference image geometry|1;0;0;|";
  writeFile(folder / "s.seg.nrrd", std::vector<std::uint8_t>(24, 1), geometry);
  const Segmentation s = readSegmentation(folder / "s.seg.nrrd");
  ASSERT_EQ(s.segments().size(), 1u);
  EXPECT_EQ(s.segments()[0].name, "left lung | upper: lobe; \"A\" = 1");
  EXPECT_EQ(s.makeFocusMask({s.segments()[0].name}, s.grid()).count, 24);
}

TEST(SegmentationReader, PlacesTheOldestFilesByTheirExtentField) {
  const TemporaryFolder folder;
  FileGeometry geometry{.size = {3, 4, 2, 2},
                        .directions = {{-1, 0, 0}, {0, -1, 0}, {0, 0, 1}},
                        .spacing = {2, 3, 4},
                        .origin = {100, 200, -50}};
  geometry.fields["Segmentation_Extent"] = "10 12 20 23 5 6";
  for (const int n : {0, 1}) { // one frame per segment, with value 1
    const std::string prefix = "Segment" + std::to_string(n) + "_";
    geometry.fields[prefix + "ID"] = n == 0 ? "a" : "b";
    geometry.fields[prefix + "Name"] = n == 0 ? "liver" : "tumor";
    geometry.fields[prefix + "DefaultColor"] = "0.5 0.5 0.5";
    geometry.fields[prefix + "Extent"] = "10 12 20 23 5 6";
  }
  std::vector<std::uint8_t> frames(48, 0);
  frames[0] = frames[1] = 1;       // liver: voxels 0 0 0 and 1 0 0
  frames[24 + 1] = 1;              // tumor: 1 0 0,
  frames[24 + 1 + 3 * 3 + 12] = 1; // and 1 3 1
  writeFile(folder / "s.seg.nrrd", frames, geometry);
  const Segmentation s = readSegmentation(folder / "s.seg.nrrd");
  ASSERT_EQ(s.segments().size(), 2u);
  EXPECT_EQ(s.makeFocusMask({"liver"}, s.grid()).count, 2);
  EXPECT_TRUE(
      isApprox(computeCentroid(s, "liver"), Vec3(100 - 10.5 * 2, 200 - 20 * 3, -50 + 5 * 4)));
  EXPECT_EQ(s.makeFocusMask({"tumor"}, s.grid()).count, 2);
  EXPECT_TRUE(
      isApprox(computeCentroid(s, "tumor"), Vec3(100 - 11 * 2, 200 - 21.5 * 3, -50 + 5.5 * 4)));
  EXPECT_EQ(s.makeFocusMask({"a", "b"}, s.grid()).count, 3);

  geometry.fields["Segmentation_Extent"] = "10 12 20 23 5";
  writeFile(folder / "s.seg.nrrd", frames, geometry);
  expectRefused(folder / "s.seg.nrrd", "invalid-field: Segmentation_Extent",
                [&] { readSegmentation(folder / "s.seg.nrrd"); });
}

TEST(SegmentationReader, RefusesFramesWithoutSegments) {
  const TemporaryFolder folder;
  writeFile(folder / "s.nrrd", std::vector<std::uint8_t>(48, 1), {.size = {3, 4, 2, 2}});
  expectRefused(folder / "s.nrrd", "unsupported-file",
                [&] { readSegmentation(folder / "s.nrrd"); });
}

TEST(SegmentationReader, RefusesABrokenGzipStream) {
  const TemporaryFolder folder;
  FileGeometry geometry{.size = {32, 32, 32}, .compress = true};
  addSegment(geometry, 0, "a", "liver", "1", "0");
  std::vector<std::uint8_t> labels(32768);
  for (std::size_t i = 0; i < labels.size(); ++i) // almost incompressible
    labels[i] = static_cast<std::uint8_t>((i * 2654435761u >> 13) & 1);
  const std::filesystem::path file = folder / "s.seg.nrrd";
  writeFile(file, labels, geometry);
  const std::string full = readBytes(file);
  const std::size_t samples = full.find("\n\n") + 2;
  const auto refuse = [&](const std::string& bytes, const char* what) {
    SCOPED_TRACE(what);
    folder.write("s.seg.nrrd", bytes);
    expectRefused(file, "damaged-file", [&] { readSegmentation(file); });
  };
  const std::size_t half = samples + (full.size() - samples) / 2;
  refuse(full.substr(0, samples), "no stream");
  refuse(full.substr(0, half), "half of the stream");
  refuse(full.substr(0, full.size() - 9), "last block truncated");
  refuse(full.substr(0, full.size() - 4), "length field missing");
  std::string damaged = full;
  damaged[half] = static_cast<char>(damaged[half] ^ 0x10);
  refuse(damaged, "flipped bit");
  damaged = full;
  damaged[full.size() - 6] = static_cast<char>(damaged[full.size() - 6] ^ 1);
  refuse(damaged, "wrong checksum");
}

TEST(SegmentationReader, StatisticsHaveVoxelsAndBoundsOfEachSegment) {
  // Permuted axes: index x runs along S, y along L, z along A.
  const Affine map(Mat3({0, 0, 1}, {-2, 0, 0}, {0, 3, 0}), {10, 20, 30});
  const Grid grid({4, 5, 6}, map);
  LargeArray<std::uint8_t> labels(240, 0); // two layers
  for (const Size3& voxel : {Size3(1, 2, 3), Size3(2, 2, 3), Size3(1, 4, 5)})
    labels[2 * static_cast<std::size_t>(toIndex(grid, voxel.x(), voxel.y(), voxel.z()))] = 1;
  labels[1] = 1;
  Segmentation s("test", grid, 2, labels,
                 {{.id = "a", .name = "a"},
                  {.id = "b", .name = "b", .layer = 1},
                  {.id = "c", .name = "c", .labelValue = 9}});
  const std::vector<SegmentStatistics> statistics = s.statistics();
  ASSERT_EQ(statistics.size(), 3u);
  EXPECT_EQ(statistics[0].voxels, 3);
  EXPECT_TRUE(isApprox(statistics[0].bounds.lower, Vec3(10 - 2 * 4.5, 20 + 3 * 2.5, 30.5)));
  EXPECT_TRUE(isApprox(statistics[0].bounds.upper, Vec3(10 - 2 * 1.5, 20 + 3 * 5.5, 32.5)));
  EXPECT_EQ(statistics[1].voxels, 1);
  EXPECT_TRUE(isApprox(statistics[1].bounds.lower, Vec3(9, 18.5, 29.5)));
  EXPECT_EQ(statistics[2].voxels, 0);
  EXPECT_TRUE(statistics[2].bounds.upper == Vec3::Zero());

  const Vec3 native = s.nativeSpacing();
  s.divideVoxels();
  EXPECT_TRUE(isApprox(s.grid().spacing(), 0.5 * grid.spacing()));
  EXPECT_TRUE(isApprox(s.nativeSpacing(), native));
  const std::vector<SegmentStatistics> divided = s.statistics();
  for (std::size_t i = 0; i < divided.size(); ++i) {
    EXPECT_EQ(divided[i].voxels, 8 * statistics[i].voxels);
    EXPECT_TRUE(isApprox(divided[i].bounds.lower, statistics[i].bounds.lower));
    EXPECT_TRUE(isApprox(divided[i].bounds.upper, statistics[i].bounds.upper));
  }
}

} // namespace
} // namespace fenestra::core::SegmentationReaderTests
