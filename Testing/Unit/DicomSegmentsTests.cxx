// DICOM segmentations and structure sets of known shapes, and damaged files.

#include "files/segments/DicomSegments.h"

#include "Approx.h"
#include "DicomObjectFiles.h"
#include "MedicalFiles.h"

#include <random>
#include <sys/resource.h>

namespace fenestra::core::DicomSegmentsTests {
namespace {

using Path = std::filesystem::path;
using Inside = std::function<bool(const Vec3&)>; ///< of a point, LPS mm

Mat3 makeAxes(const Vec3& row, const Vec3& column) {
  return {row, column, row.cross(column)};
}

/// Axial, sagittal, coronal and oblique planes.
std::vector<Mat3> listOrientations() {
  return {
      Mat3::Identity(), makeAxes(Vec3::UnitY(), -Vec3::UnitZ()),
      makeAxes(Vec3::UnitX(), -Vec3::UnitZ()), makeAxes(-Vec3::UnitX(), Vec3::UnitY()),
      (makeRotation(0.4, Vec3(1, 2, 3).normalized()) * makeRotation(0.3, Vec3::UnitX())).linear()};
}

/// Adds the frames on which the shape of a segment has pixels, each with pixels of `value`.
void addFrames(SegFile& file, unsigned segment, int slices, const Inside& isInside,
               unsigned value = 1) {
  SegFile geometry = file;
  geometry.frames.clear();
  for (int slice = 0; slice < slices; ++slice) {
    const auto pixel = [geometry, slice, isInside, value](int x, int y) {
      return isInside(geometry.locate(x, y, slice)) ? value : 0U;
    };
    bool hasPixel = false;
    for (int y = 0; y < static_cast<int>(file.rows); ++y)
      for (int x = 0; x < static_cast<int>(file.columns); ++x)
        hasPixel = hasPixel || pixel(x, y) != 0;
    if (hasPixel)
      file.frames.push_back({segment, static_cast<double>(slice), pixel});
  }
}

/// World points of the voxels of a segment, RAS.
std::vector<Vec3> listVoxels(const Segmentation& segmentation, const std::string& name) {
  const Grid& grid = segmentation.grid();
  const Mask mask = segmentation.makeMask({segmentation.segments()[segmentation.find(name)]}, grid);
  std::vector<Vec3> points;
  for (std::int64_t z = 0; z < mask.grid.size.z(); ++z)
    for (std::int64_t y = 0; y < mask.grid.size.y(); ++y)
      for (std::int64_t x = 0; x < mask.grid.size.x(); ++x) {
        const Vec3 index = Vec3(double(x), double(y), double(z));
        const Vec3 inGrid = grid.worldToIndex * (mask.grid.indexToWorld * index);
        const Size3 voxel = inGrid.array().round().cast<std::int64_t>();
        if (mask.contains({x, y, z}) && (voxel.array() >= 0).all() &&
            (voxel.array() < grid.size.array()).all())
          points.push_back(mask.grid.indexToWorld * index);
      }
  return points;
}

/// Dice coefficient of a segment and a shape sampled at the voxel centers of the segmentation's
/// grid, enlarged by a few voxels.
double computeDice(const Segmentation& segmentation, const std::string& name,
                   const Inside& isInside) {
  const std::vector<Vec3> points = listVoxels(segmentation, name);
  const auto common =
      std::ranges::count_if(points, [&](const Vec3& point) { return isInside(lpsToRas * point); });
  const Grid& grid = segmentation.grid();
  std::int64_t expected = 0;
  for (std::int64_t z = -3; z < grid.size.z() + 3; ++z)
    for (std::int64_t y = -3; y < grid.size.y() + 3; ++y)
      for (std::int64_t x = -3; x < grid.size.x() + 3; ++x)
        expected +=
            isInside(lpsToRas * (grid.indexToWorld * Vec3(double(x), double(y), double(z))));
  return 2.0 * static_cast<double>(common) /
         static_cast<double>(expected + static_cast<std::int64_t>(points.size()));
}

Inside makeShell(const Vec3& center, double inner, double outer) {
  return [=](const Vec3& point) {
    const double radius = (point - center).norm();
    return radius >= inner && radius < outer;
  };
}

// ---- segmentations

SegFile makeSphereFile(const Mat3& axes, const Vec3& center) {
  SegFile file{.columns = 31, .rows = 29, .axes = axes, .columnSpacing = 0.75, .rowSpacing = 0.8};
  file.step = file.statedStep = 1.25;
  file.origin = center - axes * Vec3(15 * 0.75, 14 * 0.8, 9 * 1.25);
  file.segments = {{1, "sphere"}, {2, "shell"}};
  addFrames(file, 2, 19, makeShell(center, 5.017, 9.511));
  addFrames(file, 1, 19, makeShell(center, 0.0, 8.013));
  std::shuffle(file.frames.begin(), file.frames.end(), std::mt19937(7)); // NOLINT: reproducible
  return file;
}

TEST(DicomSegments, FramesInAnyOrderAndOrientationLieWhereTheySay) {
  const TemporaryFolder folder;
  const Vec3 center(12, -34, 56);
  for (const Mat3& axes : listOrientations())
    for (const bool isShared : {true, false}) {
      SegFile file = makeSphereFile(axes, center);
      file.isShared = isShared;
      const auto read = readSegmentation(folder.write("no-extension", makeSegFile(file)));
      EXPECT_TRUE(read.warnings().empty());
      const Grid& grid = read.grid();
      ASSERT_EQ(grid.size.x(), 31);
      ASSERT_EQ(grid.size.y(), 29);
      const double last = static_cast<double>(grid.size.z()) - 1.0;
      double slice = 99.0;
      for (const SegFile::Frame& frame : file.frames)
        slice = std::min(slice, frame.slice);
      for (const double x : {0.0, 30.0})
        for (const double y : {0.0, 28.0})
          for (const double z : {0.0, last})
            EXPECT_LT((grid.indexToWorld * Vec3(x, y, z) - lpsToRas * file.locate(x, y, slice + z))
                          .norm(),
                      1e-4);
      EXPECT_EQ(computeDice(read, "sphere", makeShell(center, 0.0, 8.013)), 1.0);
      EXPECT_EQ(computeDice(read, "shell", makeShell(center, 5.017, 9.511)), 1.0);
      EXPECT_NE(read.segments()[0].layer, read.segments()[1].layer) << "they overlap";
    }
}

TEST(DicomSegments, EveryTransferSyntaxGivesTheSameLabels) {
  using dicom::Syntax;
  const TemporaryFolder folder;
  const Vec3 center(1, 2, 3);
  const SegFile file = makeSphereFile(Mat3::Identity(), center);
  for (const Syntax syntax :
       {Syntax::implicitLittle, Syntax::explicitLittle, Syntax::explicitBig, Syntax::deflated})
    for (const bool hasLengths : {true, false}) {
      const auto read =
          readSegmentation(folder.write("s.dcm", makeSegFile(file, syntax, hasLengths)));
      EXPECT_EQ(computeDice(read, "sphere", makeShell(center, 0.0, 8.013)), 1.0) << int(syntax);
      EXPECT_EQ(computeDice(read, "shell", makeShell(center, 5.017, 9.511)), 1.0) << int(syntax);
    }
}

TEST(DicomSegments, FractionalSegmentsBeginAtHalfOfTheMaximum) {
  using dicom::Syntax;
  const TemporaryFolder folder;
  for (const Syntax syntax : {Syntax::explicitLittle, Syntax::explicitBig, Syntax::rle})
    for (const unsigned maximum : {255U, 100U}) {
      SegFile file{.type = "FRACTIONAL", .columns = 255, .rows = 1, .bits = 8, .maximum = maximum};
      file.thickness = 2.0;
      const auto pixel = [](int x, int) { return static_cast<unsigned>(x); };
      file.frames = {{1, 0.0, pixel}};
      const auto read = readSegmentation(folder.write("s.dcm", makeSegFile(file, syntax)));
      const unsigned first = (maximum + 1) / 2;
      EXPECT_EQ(read.statistics()[0].voxels, 255 - first);
      EXPECT_NEAR(read.statistics()[0].bounds.upper.x(), 0.5 - first, 1e-4); // LPS to RAS
      EXPECT_NEAR(read.grid().spacing().z(), 2.0, 1e-12);
    }
}

TEST(DicomSegments, LabelMapsHaveSegmentNumbersAsPixels) {
  using dicom::Syntax;
  const TemporaryFolder folder;
  for (const Syntax syntax :
       {Syntax::implicitLittle, Syntax::explicitLittle, Syntax::explicitBig, Syntax::rle})
    for (const unsigned bits : {8U, 16U}) {
      const unsigned high = bits == 8 ? 200 : 60000;
      SegFile file{.type = "LABELMAP", .bits = bits};
      file.segments = {{0, "background"}, {3, "low"}, {high, "high"}};
      file.frames = {{0, 1.0, [](int x, int) { return x < 2 ? 3U : 0U; }},
                     {0, 0.0, [=](int x, int y) { return x == 8 && y == 6 ? high : 0U; }}};
      const auto read = readSegmentation(folder.write("s.dcm", makeSegFile(file, syntax)));
      ASSERT_EQ(read.segments().size(), 2u);
      EXPECT_EQ(read.statistics()[0].voxels, 2 * 7);
      ASSERT_EQ(read.statistics()[1].voxels, 1);
      EXPECT_TRUE(isApprox(read.statistics()[1].bounds.center(), Vec3(-8, -6, 0)));
      EXPECT_EQ(read.segments()[1].labelValue, static_cast<std::int32_t>(high));
    }
}

TEST(DicomSegments, NamesColorsAndCodesAreThoseOfTheFile) {
  const TemporaryFolder folder;
  SegFile file{.segments = {{2, "Leber f\xfcr", {34886, 53485, 50171}, "123037004", "10200004"},
                            {5, "", {}, "49755003", "4147007", "12738006"}}};
  file.characterSet = "ISO_IR 100";
  file.frames = {{2, 0.0}, {5, 1.0}};
  const Path path = folder.write("s.dcm", makeSegFile(file));
  const auto segments = readSegmentInfos(path);
  ASSERT_EQ(segments.size(), 2u);
  EXPECT_EQ(segments[0].name, "Leber f\xc3\xbcr");
  EXPECT_EQ(segments[0].id, "Segment_2");
  EXPECT_EQ(segments[0].labelValue, 2);
  EXPECT_EQ(segments[0].category, "SCT^123037004");
  EXPECT_EQ(segments[0].type, "SCT^10200004");
  EXPECT_EQ(segments[1].name, "Segment_5");
  EXPECT_EQ(segments[1].region, "SCT^12738006");
  // L 53.23, a 80.11, b 67.22: red of sRGB, by the formulas of CIE 1976.
  EXPECT_LT((segments[0].color - Rgb(1, 0, 0)).abs().maxCoeff(), 0.01);
  EXPECT_EQ(readSegmentation(path).segments()[1].name, "Segment_5");
  EXPECT_THROW(readSegmentation(path, nullptr, "totalsegmentator"), Error);
}

TEST(DicomSegments, MissingSlicesAreEmpty) {
  const TemporaryFolder folder;
  SegFile file{.step = 3.0, .statedStep = 3.0};
  file.frames = {{1, 7.0}, {1, 2.0}, {1, 4.0}}; // no two are adjacent
  const auto sparse = readSegmentation(folder.write("s.dcm", makeSegFile(file)));
  EXPECT_EQ(sparse.grid().size.z(), 6);
  EXPECT_EQ(sparse.statistics()[0].voxels, 3 * 63);
  file.statedStep = 0.0;
  file.thickness = 3.0;
  const Grid volume({9, 9, 9}, Affine(Mat3::Diagonal(Vec3(1, 1, 3)), Vec3::Zero()));
  EXPECT_EQ(readSegmentation(folder / "s.dcm").grid().size.z(), 6);
  folder.write("t.dcm", makeSegFile(file));
  EXPECT_EQ(readSegmentation(folder / "t.dcm", &volume).grid().size.z(), 6);
  // Without a stated distance or a volume, the smallest gap is that of the slices.
  file.frames.push_back({1, 3.0});
  EXPECT_EQ(readSegmentation(folder.write("u.dcm", makeSegFile(file))).grid().size.z(), 6);
}

TEST(DicomSegments, UnevenSlicesGiveAWarningAndNoGap) {
  const TemporaryFolder folder;
  SegFile file;
  file.frames = {{1, 0.0}, {1, 1.0}, {1, 2.0}, {1, 3.5}, {1, 4.5}, {1, 6.5}, {1, 7.5}};
  const auto read = readSegmentation(folder.write("s.dcm", makeSegFile(file)));
  ASSERT_EQ(read.warnings().size(), 1u);
  expectMessage(read.warnings()[0], "assumed-geometry");
  ASSERT_EQ(read.grid().size.z(), 9);
  EXPECT_EQ(read.statistics()[0].voxels, 8 * 63) << "only the gap of two steps is empty";
}

TEST(DicomSegments, RejectsWhatItCannotPlace) {
  const TemporaryFolder folder;
  const auto expect = [&](const SegFile& file, const char* message) {
    const Path path = folder.write("s.dcm", makeSegFile(file));
    expectRefused(path, message, [&] { readSegmentation(path); });
  };
  SegFile file{.statedStep = 1.0};
  expect(file, "invalid-field: PerFrameFunctionalGroupsSequence");
  file.frames = {{1, 0.0}, {2, 1.0}};
  expect(file, "invalid-field: ReferencedSegmentNumber | 2");
  file.frames = {{1, 0.0}, {1, 1e6}};
  expect(file, "invalid-field: ImagePositionPatient | 65536");
  file.frames = {{1, 0.0}};
  file.rowSpacing = 0.0;
  expect(file, "invalid-field: PixelSpacing");
  file = {.axes = makeAxes(Vec3::UnitX(), Vec3(1, 1, 0)), .frames = {{1, 0.0}}};
  expect(file, "invalid-field: ImageOrientationPatient");
  file = {.segments = {{1, "a"}, {1, "b"}}, .frames = {{1, 0.0}}};
  expect(file, "invalid-field: SegmentNumber");
  file = {.type = "SURFACE", .frames = {{1, 0.0}}};
  expect(file, "invalid-field: SegmentationType | SURFACE");
  file = {.type = "FRACTIONAL", .bits = 8, .frames = {{1, 0.0}}};
  expect(file, "invalid-field: MaximumFractionalValue");
  file = {.segments = {}, .frames = {{1, 0.0}}};
  expect(file, "invalid-file");
  file = {.columns = 64, .rows = 64, .frames = {{1, 0.0}, {1, 1.0}}};
  const std::string bytes = makeSegFile(file);
  const Path half = folder.write("half.dcm", bytes.substr(0, bytes.size() - 100));
  expectRefused(half, "damaged-file: PixelData", [&] { readSegmentation(half); });
  std::string image = bytes; // an MR image
  image.replace(image.find("1.2.840.10008.5.1.4.1.1.66.4"), 28, "1.2.840.10008.5.1.4.1.1.4\0\0\0",
                28);
  while (image.find("1.2.840.10008.5.1.4.1.1.66.4") != std::string::npos)
    image.replace(image.find("1.2.840.10008.5.1.4.1.1.66.4"), 28, "1.2.840.10008.5.1.4.1.1.4\0\0\0",
                  28);
  const Path other = folder.write("mr.dcm", image);
  expectRefused(other, "unsupported-file | SEG", [&] { readSegmentation(other); });
}

// ---- memory

/// Replaces the number of an element of type US, explicit little endian.
void setShort(std::string& bytes, unsigned element, unsigned value) {
  const std::string tag = {0x28, 0, static_cast<char>(element), 0, 'U', 'S', 2, 0};
  const std::size_t at = bytes.find(tag) + tag.size();
  bytes[at] = static_cast<char>(value & 255U);
  bytes[at + 1] = static_cast<char>(value >> 8);
}

double getPeakMegabytes(int who) {
  rusage usage{};
  ::getrusage(static_cast<__rusage_who_t>(who), &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

TEST(DicomSegments, DamagedSizesTakeNoMemory) {
  const TemporaryFolder folder;
  constexpr double most = 100.0; // MB, for files of 2 kB
  const double before = getPeakMegabytes(RUSAGE_SELF);
  SegFile file{.statedStep = 1.0, .segments = {{1, "empty"}, {2, "two"}}, .frames = {{2, 0.0}}};
  std::string bytes = makeSegFile(file);
  for (const unsigned element : {0x10U, 0x11U})
    setShort(bytes, element, 40000);
  const Path large = folder.write("large.dcm", bytes);
  expectRefused(large, "damaged-file: PixelData", [&] { readSegmentation(large); });
  file = {.columns = 100, .rows = 40, .statedStep = 1.0, .frames = {{1, 0.0}, {1, 60000.0}}};
  const Path sparse = folder.write("sparse.dcm", makeSegFile(file));
  expectRefused(sparse, "limit-exceeded | 240004000", [&] { readSegmentation(sparse); });
  EXPECT_LT(getPeakMegabytes(RUSAGE_SELF) - before, most);
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__clang__) // sanitizers take memory of their own
TEST(DicomSegments, DeclaredLengthsTakeNoMemoryInTheChild) {
  const TemporaryFolder folder;
  const double before = getPeakMegabytes(RUSAGE_CHILDREN);
  std::string bytes = makeSegFile({.frames = {{1, 0.0}}});
  const std::string element("\x62\0\x51\0OB\0\0\0\0\0\x70", 12); // 1.9 GB
  bytes.insert(bytes.find(std::string("\x00\x52\x30\x92SQ", 6)), element);
  const Path path = folder.write("s.dcm", bytes);
  expectRefused(path, "damaged-file", [&] { readSegmentation(path); });
  EXPECT_LT(getPeakMegabytes(RUSAGE_CHILDREN), std::max(before, 400.0));
}
#endif

} // namespace
} // namespace fenestra::core::DicomSegmentsTests
