// Structure sets of known shapes, and damaged files.

#include "files/segments/DicomSegments.h"

#include "Approx.h"
#include "DicomObjectFiles.h"
#include "MedicalFiles.h"

#include <random>

namespace fenestra::core::StructureSetTests {
namespace {

using Path = std::filesystem::path;
using Contour = std::vector<Vec3>;

/// Circle of a contoured shape; LPS mm.
Contour makeCircle(const Vec3& center, const Mat3& axes, double radius, int points = 120) {
  Contour contour;
  for (int i = 0; i < points; ++i) {
    const double angle = 2.0 * pi * i / points;
    contour.push_back(center + radius * axes * Vec3(std::cos(angle), std::sin(angle), 0.0));
  }
  return contour;
}

/// Contours of a sphere in planes at multiples of `step` along the third axis, from the center.
std::vector<Contour> makeSphere(const Vec3& center, const Mat3& axes, double radius, double step) {
  std::vector<Contour> contours;
  const int last = static_cast<int>(radius / step);
  for (int i = -last; i <= last; ++i) {
    const double height = i * step, across = std::sqrt(radius * radius - height * height);
    if (across > 0.0)
      contours.push_back(makeCircle(center + height * axes.col(2), axes, across));
  }
  return contours;
}

/// Grid of 64^3 voxels along `axes` (LPS) around a point.
Grid makeVolume(const Vec3& center, const Mat3& axes, const Vec3& spacing) {
  const Vec3 origin = center - axes * (32.0 * spacing);
  return {{65, 65, 65}, Affine(lpsToRas * axes * Mat3::Diagonal(spacing), lpsToRas * origin)};
}

/// Mask of a segment, sampled at points (LPS).
struct Sampled {
  Mask mask;
  bool contains(const Vec3& lps) const {
    const Vec3 index = mask.grid.worldToIndex * (lpsToRas * lps);
    const Size3 voxel = index.array().round().cast<std::int64_t>();
    return mask.contains(voxel);
  }
};

Sampled sample(const Segmentation& segmentation, std::size_t segment = 0) {
  return {segmentation.makeMask({segmentation.segments()[segment]}, segmentation.grid())};
}

/// Dice coefficient of a segment and a shell around `center`, at the voxels of the segmentation.
double computeDice(const Segmentation& segmentation, const Vec3& center, double inner, double outer,
                   std::size_t segment = 0) {
  const Sampled sampled = sample(segmentation, segment);
  const Grid& grid = segmentation.grid();
  std::int64_t common = 0, both = 0;
  for (std::int64_t z = -2; z < grid.size.z() + 2; ++z)
    for (std::int64_t y = -2; y < grid.size.y() + 2; ++y)
      for (std::int64_t x = -2; x < grid.size.x() + 2; ++x) {
        const Vec3 point = lpsToRas * (grid.indexToWorld * Vec3(double(x), double(y), double(z)));
        const double radius = (point - center).norm();
        const bool expected = radius >= inner && radius < outer, found = sampled.contains(point);
        common += expected && found;
        both += expected + found;
      }
  return 2.0 * static_cast<double>(common) / static_cast<double>(both);
}

Mat3 makeOblique() {
  return (makeRotation(0.4, Vec3(1, 2, 3).normalized()) * makeRotation(0.3, Vec3::UnitX()))
      .linear();
}

TEST(StructureSet, SphereIsFilledOnTheVolumesGrid) {
  const TemporaryFolder folder;
  const Vec3 center(10, -20, 30);
  for (const Mat3& axes : {Mat3::Identity(), makeOblique()}) {
    const Path path = folder.write(
        "s.dcm", makeStructureFile({{.contours = makeSphere(center, axes, 20.3, 1.0)}}));
    const Mat3 turned(axes.col(2), axes.col(0), axes.col(1)); // slices are its first axis
    for (const Grid& volume :
         {makeVolume(center, axes, {1, 1, 1}), makeVolume(center, turned, {1, 1, 1})}) {
      const Segmentation read = readSegmentation(path, &volume);
      EXPECT_GE(computeDice(read, center, 0.0, 20.3), 0.9985);
      EXPECT_TRUE(read.warnings().empty());
      const Vec3 inVolume = volume.worldToIndex * read.grid().indexToWorld.translation();
      EXPECT_TRUE(isApprox(inVolume, Vec3(inVolume.array().round()), 1e-6)) << "same voxels";
    }
  }
}

TEST(StructureSet, CornersLieWhereTheyAreContoured) {
  const TemporaryFolder folder;
  const Vec3 center(7, 8, 9);
  for (const Mat3& axes : {Mat3::Identity(), makeOblique()}) {
    std::vector<Contour> contours;
    for (int z = -3; z <= 3; ++z) // edges between voxels, at 4.5 and 5.5
      contours.push_back({center + axes * Vec3(-4.5, -5.5, z), center + axes * Vec3(4.5, -5.5, z),
                          center + axes * Vec3(4.5, 5.5, z), center + axes * Vec3(-4.5, 5.5, z)});
    const Grid volume = makeVolume(center, axes, {1, 1, 1});
    const Segmentation read = readSegmentation(
        folder.write("s.dcm", makeStructureFile({{.contours = contours}})), &volume);
    const Sampled sampled = sample(read);
    EXPECT_EQ(read.statistics()[0].voxels, 9 * 11 * 7);
    for (const double x : {-4.0, 4.0})
      for (const double y : {-5.0, 5.0})
        for (const double z : {-3.0, 3.0})
          EXPECT_TRUE(sampled.contains(center + axes * Vec3(x, y, z)));
    const Vec3 index = volume.worldToIndex * (read.grid().indexToWorld * Vec3(0, 0, 0));
    EXPECT_LT((volume.indexToWorld * Vec3(index.array().round()) -
               read.grid().indexToWorld * Vec3(0, 0, 0))
                  .norm(),
              1e-4);
  }
}

TEST(StructureSet, SkippedSlicesAreInterpolated) {
  const TemporaryFolder folder;
  const Vec3 center(0, 0, 0);
  const Mat3 axes = Mat3::Identity();
  const Grid volume = makeVolume(center, axes, {1, 1, 1});
  std::vector<Contour> contours = makeSphere(center, axes, 24.4, 3.0);
  const auto read = [&] {
    return readSegmentation(folder.write("s.dcm", makeStructureFile({{.contours = contours}})),
                            &volume);
  };
  const Segmentation regular = read();
  EXPECT_GE(computeDice(regular, center, 0.0, 24.4), 0.99);
  EXPECT_TRUE(regular.warnings().empty());
  for (int z = -22; z <= 22; ++z) // inside the sphere, between contours
    EXPECT_TRUE(sample(regular).contains(Vec3(0, 0, z))) << z;
  // One more contour is missing: also interpolated, with a warning.
  contours.erase(contours.begin() + 5);
  const Segmentation irregular = read();
  EXPECT_GE(computeDice(irregular, center, 0.0, 24.4), 0.985);
  ASSERT_EQ(irregular.warnings().size(), 1u);
  expectMessage(irregular.warnings()[0], "assumed-geometry | one | 6 mm");
}

/// Dice coefficient of a sphere around the origin and of its planes of contours, each of which
/// holds for half of the distance to the next; at points 1 mm apart.
double computeSampledDice(double radius, double step, double phase) {
  std::int64_t common = 0, both = 0;
  for (int z = -30; z <= 30; ++z) {
    const double plane = step * (std::floor(z / step - phase + 0.5) + phase);
    for (int y = -30; y <= 30; ++y)
      for (int x = -30; x <= 30; ++x) {
        const double across = x * x + y * y;
        const bool expected = across + z * z < radius * radius,
                   found = across + plane * plane < radius * radius;
        common += expected && found;
        both += expected + found;
      }
  }
  return 2.0 * static_cast<double>(common) / static_cast<double>(both);
}

TEST(StructureSet, CoarseContoursAreBetterThanTheShapeSampledOnThem) {
  const TemporaryFolder folder;
  constexpr double radius = 24.4;
  const Grid volume = makeVolume(Vec3::Zero(), Mat3::Identity(), {1, 1, 1});
  for (const double step : {2.0, 3.0, 4.0, 5.0})
    for (const double phase : {0.0, 0.5}) { // of the first plane, in steps from the center
      std::vector<Contour> contours;
      for (int i = -20; i <= 20; ++i)
        if (const double z = step * (i + phase); std::abs(z) < radius - 0.01)
          contours.push_back(
              makeCircle(Vec3(0, 0, z), Mat3::Identity(), std::sqrt(radius * radius - z * z)));
      const Segmentation read = readSegmentation(
          folder.write("s.dcm", makeStructureFile({{.contours = contours}})), &volume);
      const double dice = computeDice(read, Vec3::Zero(), 0.0, radius);
      EXPECT_GE(dice, computeSampledDice(radius, step, phase)) << step << ' ' << phase;
      EXPECT_GE(dice, step == 2.0 ? 0.995 : 0.98) << step << ' ' << phase;
    }
}

TEST(StructureSet, PartsFarApartStayApart) {
  const TemporaryFolder folder;
  std::vector<Contour> contours;
  for (const int z : {-20, -19, -18, -17, 10, 11, 12, 13})
    contours.push_back(makeCircle(Vec3(0, 0, z), Mat3::Identity(), 6.2));
  const Grid volume = makeVolume(Vec3::Zero(), Mat3::Identity(), {1, 1, 1});
  const Segmentation read =
      readSegmentation(folder.write("s.dcm", makeStructureFile({{.contours = contours}})), &volume);
  const Sampled sampled = sample(read);
  for (int z = -30; z <= 30; ++z)
    EXPECT_EQ(sampled.contains(Vec3(0, 0, z)), (z >= -20 && z <= -17) || (z >= 10 && z <= 13)) << z;
}

TEST(StructureSet, HolesAreContoursOrKeyholes) {
  const TemporaryFolder folder;
  const Mat3 axes = Mat3::Identity();
  const Vec3 center(3, 4, 5);
  const Grid volume = makeVolume(center, axes, {1, 1, 1});
  for (const double step : {1.0, 2.0})
    for (const bool isKeyhole : {false, true}) {
      std::vector<Contour> contours = makeSphere(center, axes, 24.3, step);
      const std::vector<Contour> inner = makeSphere(center, axes, 12.4, step);
      for (const Contour& hole : inner)
        if (!isKeyhole) {
          contours.push_back(hole);
        } else { // out to the hole, around it, and back
          for (Contour& contour : contours)
            if (contour[0].z() == hole[0].z()) {
              contour.push_back(contour.front());
              contour.insert(contour.end(), hole.begin(), hole.end());
              contour.push_back(hole.front());
            }
        }
      const Segmentation read = readSegmentation(
          folder.write("s.dcm", makeStructureFile({{.contours = contours}})), &volume);
      EXPECT_GE(computeDice(read, center, 12.4, 24.3), step == 1.0 ? 0.9985 : 0.99)
          << step << isKeyhole;
      EXPECT_FALSE(sample(read).contains(center));
    }
}

TEST(StructureSet, ExclusiveContoursLeaveHoles) {
  const TemporaryFolder folder;
  std::vector<Contour> contours;
  for (int z = 0; z < 3; ++z)
    for (const double radius : {9.3, 4.3})
      contours.push_back(makeCircle(Vec3(0, 0, z), Mat3::Identity(), radius));
  const Grid volume = makeVolume(Vec3::Zero(), Mat3::Identity(), {1, 1, 1});
  const Segmentation read = readSegmentation(
      folder.write("s.dcm",
                   makeStructureFile({{.contours = contours, .type = "CLOSEDPLANAR_XOR"}})),
      &volume);
  EXPECT_TRUE(sample(read).contains(Vec3(7, 0, 1)));
  EXPECT_FALSE(sample(read).contains(Vec3(0, 0, 1)));
}

TEST(StructureSet, SeveralAndRepeatedContoursOfASlice) {
  const TemporaryFolder folder;
  std::vector<Contour> contours;
  for (int z = 0; z < 3; ++z)
    for (const double x : {-10.0, 10.0, 10.0}) // the second circle twice
      contours.push_back(makeCircle(Vec3(x, 0, z), Mat3::Identity(), 5.3));
  const Grid volume = makeVolume(Vec3::Zero(), Mat3::Identity(), {1, 1, 1});
  const Segmentation read =
      readSegmentation(folder.write("s.dcm", makeStructureFile({{.contours = contours}})), &volume);
  for (const double x : {-10.0, 10.0})
    EXPECT_TRUE(sample(read).contains(Vec3(x, 0, 1))) << x;
  EXPECT_FALSE(sample(read).contains(Vec3(0, 0, 1)));
}

TEST(StructureSet, NeedsNoParallelVolume) {
  const TemporaryFolder folder;
  const Vec3 center(1, 2, 3);
  const Path path = folder.write(
      "s.dcm", makeStructureFile({{.contours = makeSphere(center, Mat3::Identity(), 20.3, 1.0)}}));
  const Grid volume = makeVolume(center, makeOblique(), {0.9, 0.8, 1.2});
  EXPECT_GE(computeDice(readSegmentation(path, &volume), center, 0.0, 20.3), 0.995);
  EXPECT_GE(computeDice(readSegmentation(path), center, 0.0, 20.3), 0.995);
}

TEST(StructureSet, OverlappingStructuresHaveLayersNamesAndColors) {
  const TemporaryFolder folder;
  const Mat3 axes = Mat3::Identity();
  const std::vector<RoiFile> rois = {
      {7, "PTV", {0, 255, 51}, makeSphere(Vec3::Zero(), axes, 15.2, 1.0)},
      {9, "GTV ", {255, 0, 0}, makeSphere(Vec3::Zero(), axes, 8.3, 1.0)},
      {12, "marker", {1, 2, 3}, {{Vec3(1, 1, 1)}}, "POINT"}};
  for (const bool hasNumbers : {true, false}) {
    const Path path =
        folder.write("s.dcm", makeStructureFile(rois, dicom::Syntax::explicitLittle, hasNumbers));
    const Grid volume = makeVolume(Vec3::Zero(), axes, {1, 1, 1});
    const Segmentation read = readSegmentation(path, &volume);
    const auto& segments = read.segments();
    ASSERT_EQ(segments.size(), 3u);
    EXPECT_EQ(segments[0].name, "PTV");
    EXPECT_EQ(segments[1].name, "GTV");
    EXPECT_EQ(segments[0].id, "ROI_7");
    EXPECT_EQ(segments[1].labelValue, 9);
    EXPECT_NE(segments[0].layer, segments[1].layer);
    EXPECT_LT((segments[0].color - Rgb(0, 1, 0.2)).abs().maxCoeff(), 1e-9);
    EXPECT_GE(computeDice(read, Vec3::Zero(), 0.0, 15.2, 0), 0.9985);
    EXPECT_GE(computeDice(read, Vec3::Zero(), 0.0, 8.3, 1), 0.9985);
    EXPECT_EQ(read.statistics()[2].voxels, 0);
    EXPECT_EQ(readSegmentInfos(path).size(), 3u);
  }
}

TEST(StructureSet, RejectsOrLeavesOutWhatItCannotFill) {
  const TemporaryFolder folder;
  const auto expect = [&](const std::vector<RoiFile>& rois, const char* message) {
    const Path path = folder.write("s.dcm", makeStructureFile(rois));
    expectRefused(path, message, [&] { readSegmentation(path); });
  };
  expect({}, "invalid-file");
  expect({{.contours = {{Vec3(1, 1, 1)}}, .type = "POINT"}}, "unsupported-file");
  expect({{.contours = {{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1e10, 0)}}}},
         "invalid-field: ContourData | one");
  std::vector<RoiFile> rois = {
      {1, "axial", {255, 0, 0}, makeSphere(Vec3::Zero(), Mat3::Identity(), 9.3, 1.0)},
      {2, "oblique", {255, 0, 0}, makeSphere(Vec3::Zero(), makeOblique(), 5.3, 1.0)}};
  const Segmentation read = readSegmentation(folder.write("s.dcm", makeStructureFile(rois)));
  ASSERT_EQ(read.warnings().size(), 1u);
  expectMessage(read.warnings()[0], "assumed-geometry | oblique");
  EXPECT_GT(read.statistics()[0].voxels, 0);
  EXPECT_EQ(read.statistics()[1].voxels, 0);
}

// ---- damaged files of both kinds

/// Replaces, removes, duplicates and truncates bytes.
std::string corrupt(std::string bytes, std::mt19937_64& random) {
  const auto below = [&](std::size_t limit) { return random() % limit; };
  for (std::size_t left = 1 + below(5); left > 0 && bytes.size() > 200; --left) {
    const std::size_t at = 132 + below(bytes.size() - 140);
    switch (below(6)) {
    case 0:
      bytes.replace(at, 1 + below(4), 4, below(2) ? '\xff' : '\0');
      break;
    case 1:
      bytes.erase(at, below(40));
      break;
    case 2:
      bytes.insert(at, bytes.substr(at, below(40)));
      break;
    case 3:
      if (below(4) == 0)
        bytes.resize(at);
      break;
    default:
      bytes[at] = static_cast<char>(below(256));
    }
  }
  return bytes;
}

TEST(StructureSet, DamagedFilesAreReadOrRefusedInOneLine) {
  const TemporaryFolder folder;
  std::mt19937_64 random(52); // NOLINT: reproducible
  SegFile seg{.columns = 12, .rows = 10, .statedStep = 1.0};
  seg.segments = {{1, "one", {1, 2, 3}, "123037004", "10200004"}, {2, "two"}};
  seg.frames = {{1, 0.0}, {2, 1.0}, {1, 2.0}};
  const std::vector<std::string> seeds = {
      makeSegFile(seg), makeSegFile(seg, dicom::Syntax::implicitLittle, false),
      makeStructureFile({{.contours = makeSphere(Vec3::Zero(), Mat3::Identity(), 4.3, 1.0)}})};
  const Grid volume = makeVolume(Vec3::Zero(), Mat3::Identity(), {1, 1, 1});
  int readable = 0;
  for (std::size_t i = 0; i < 24; ++i) {
    const Path path = folder.write("s.dcm", corrupt(seeds[i % seeds.size()], random));
    try {
      readDicomSegments(path, i % 3 ? &volume : nullptr);
      ++readable;
    } catch (const Error& error) {
      const std::string line = error.what();
      EXPECT_EQ(error.kind(), ErrorKind::input) << line;
      EXPECT_EQ(line.find(path.string() + ": "), 0u) << line;
      EXPECT_EQ(line.find('\n'), std::string::npos) << line;
    }
  }
  EXPECT_GT(readable, 1);
  EXPECT_LT(readable, 24);
}

} // namespace
} // namespace fenestra::core::StructureSetTests
