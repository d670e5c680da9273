// Geometry of NIfTI files: qform, sform, both, and files written by other programs; scaling.

#include "NiftiFile.h"
#include "Refusals.h"

#include "files/medical/VolumeReader.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

using namespace fenestra::core;

namespace {

const Size3 referenceSize(3, 4, 5);
const Vec3 referenceSpacing(1.0, 2.0, 3.0), referenceOrigin(10.0, -20.0, 30.0);

std::int16_t referenceValue(const Size3& voxel) {
  return static_cast<std::int16_t>(voxel.x() + 3 * (voxel.y() + 4 * voxel.z()) - 7);
}

/// True if each voxel of the volume has the reference value of its position.
bool isReference(const Volume& volume) {
  const Size3& size = volume.grid.size;
  bool isEqual = size.prod() == referenceSize.prod();
  const auto findValue = [&](std::int64_t i) {
    return std::visit([i](const auto& all) { return static_cast<double>(all[std::size_t(i)]); },
                      volume.voxels);
  };
  for (std::int64_t i = 0; i < size.prod(); ++i) {
    const Size3 voxel(i % size[0], i / size[0] % size[1], i / size[0] / size[1]);
    const Vec3 world = volume.grid.indexToWorld * voxel.cast<double>();
    const Vec3 position = (world - referenceOrigin).array() / referenceSpacing.array();
    const Vec3 nearest = position.array().round();
    isEqual &= (position - nearest).norm() < 1e-5 && (nearest.array() >= 0.0).all() &&
               findValue(i) == referenceValue(nearest.cast<std::int64_t>());
  }
  return isEqual;
}

TEST(NiftiHeader, AxisOrderAndDirectionDoNotChangeVolume) {
  const TemporaryFolder folder;
  std::array<int, 3> order = {0, 1, 2};
  do {
    for (int reversed = 0; reversed < 8; ++reversed) {
      Affine map, elsewhere = makeTranslation({500.0, 0.0, 0.0});
      NiftiFile file = makeReordered(referenceSize, referenceSpacing, referenceOrigin,
                                     referenceValue, order, reversed, map);
      // Codes and maps of qform and sform; the map `elsewhere` must be ignored.
      struct {
        std::int16_t qform, sform;
        const Affine &qformMap, &sformMap;
      } const cases[] = {{0, 2, elsewhere, map}, {1, 0, map, elsewhere}, {1, 1, map, map},
                         {2, 2, map, map},       {1, 2, elsewhere, map}, {2, 1, elsewhere, map}};
      for (const auto& test : cases) {
        const std::array<float, 4> pixdim = file.pixdim;
        file.setQform(test.qformMap);
        if (&test.qformMap == &elsewhere)
          file.pixdim = pixdim;
        file.setSform(test.sformMap);
        file.qformCode = test.qform;
        file.sformCode = test.sform;
        const Volume volume = readVolume(folder.write("v.nii", file.bytes()));
        EXPECT_EQ(volume.warnings.size(), test.qform > 0 && &test.qformMap == &elsewhere ? 1U : 0U);
        EXPECT_TRUE(isReference(volume)) << order[0] << order[1] << order[2] << " reversed "
                                         << reversed << " codes " << test.qform << test.sform;
      }
    }
  } while (std::next_permutation(order.begin(), order.end()));
}

/// A header written by nibabel, which ITK rejects as damaged.
TEST(NiftiHeader, NearlyOrthonormalSformIsAccepted) {
  NiftiFile file;
  file.sformCode = 2;
  file.pixdim = {1.0f, 0.9765625f, 0.97656244f, 0.99999511f};
  file.quaternion = {-0.98220181f, -0.02935276f, 0.01163567f};
  file.rows = {0.97461528f, 0.05210137f, -0.03372571f, 772.818f,     0.06051739f,  -0.9079209f,
               0.36303428f, 888.232f,    -0.01170732f, -0.35586426f, -0.93115997f, 563.915f};
  const TemporaryFolder folder;
  const Grid grid = readVolume(folder.write("v.nii", file.bytes())).grid;
  const Mat3 axes = grid.indexToWorld.linear().normalizedColumns();
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b)
      EXPECT_NEAR(axes.col(a).dot(axes.col(b)), a == b, 1e-14);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column)
      EXPECT_NEAR(grid.indexToWorld.linear()(row, column),
                  double(file.rows[std::size_t(4 * row + column)]), 1e-3);
    EXPECT_EQ(grid.indexToWorld.translation()[row], double(file.rows[std::size_t(4 * row + 3)]));
  }
}

/// As converters write gantry tilt, perhaps beside an upright qform.
TEST(NiftiHeader, ShearedSformIsKept) {
  const TemporaryFolder folder;
  NiftiFile file;
  file.sformCode = 1;
  const Affine tilted(Mat3(Vec3(0.5, 0, 0), Vec3(0, 0.5, 0), Vec3(0, 0.7, 2.0)), {5.0, 6.0, 7.0});
  file.setSform(tilted);
  for (const std::int16_t qform : std::to_array<std::int16_t>({0, 1})) {
    file.qformCode = qform;
    const Volume volume = readVolume(folder.write("v.nii", file.bytes()));
    EXPECT_LT((volume.grid.indexToWorld * Vec3(2, 3, 1) - tilted * Vec3(2, 3, 1)).norm(), 1e-6);
    ASSERT_EQ(volume.warnings.size(), std::size_t(qform));
  }
  expectMessage(readVolume(folder / "v.nii").warnings[0], "assumed-form | sform");
}

TEST(NiftiHeader, FlatSformIsRefusedOrReplacedByTheQform) {
  const TemporaryFolder folder;
  NiftiFile file;
  file.sformCode = 1;
  file.rows = {};
  const auto flat = folder.write("v.nii", file.bytes());
  expectRefused(flat, "invalid-field: srow", [&] { readVolume(flat); });
  file.qformCode = 1;
  const Volume volume = readVolume(folder.write("v.nii", file.bytes()));
  EXPECT_EQ(volume.grid.indexToWorld.linear(), Mat3(Mat3::Identity()));
  ASSERT_EQ(volume.warnings.size(), 1U);
  expectMessage(volume.warnings[0], "assumed-form | qform");
}

TEST(NiftiHeader, UnitsScaleGeometry) {
  const TemporaryFolder folder;
  NiftiFile file;
  file.sformCode = 1;
  file.setSform(Affine(Mat3::Diagonal({2.0, 2.0, 2.0}), {5.0, 0.0, 0.0}));
  file.pixdim = {1, 2, 2, 2};
  for (const auto& [units, factor] : {std::pair(1, 1000.0), {2, 1.0}, {3, 0.001}, {0, 1.0}}) {
    file.units = static_cast<char>(units | 8); // plus seconds
    const Affine map = readVolume(folder.write("v.nii", file.bytes())).grid.indexToWorld;
    EXPECT_NEAR(map.linear()(0, 0), 2.0 * factor, 1e-9 * factor);
    EXPECT_NEAR(map.translation()[0], 5.0 * factor, 1e-9 * factor);
  }
}

TEST(NiftiHeader, MissingSpacingWarns) {
  const TemporaryFolder folder;
  NiftiFile file;
  file.qformCode = 1;
  file.pixdim[3] = 0.0F;
  const Volume volume = readVolume(folder.write("v.nii", file.bytes()));
  EXPECT_EQ(volume.grid.spacing().z(), 1.0);
  ASSERT_EQ(volume.warnings.size(), 1u);
  expectMessage(volume.warnings[0], "assumed-geometry | 1 mm");
}

TEST(NiftiHeader, MissingFormsWarn) {
  const TemporaryFolder folder;
  const Volume volume = readVolume(folder.write("v.nii", NiftiFile().bytes()));
  EXPECT_EQ(volume.grid.indexToWorld.linear(), lpsToRas);
  ASSERT_EQ(volume.warnings.size(), 1u);
  expectMessage(volume.warnings[0], "assumed-geometry");
}

/// Found by fuzzing: the offset was converted to an integer before its range was checked.
TEST(NiftiHeader, OffsetInsideHeaderIsIgnored) {
  const TemporaryFolder folder;
  const std::string original = NiftiFile().bytes();
  for (const float offset : {-1e38f, -std::numeric_limits<float>::infinity(), 0.0f, 351.9f}) {
    std::string bytes = original;
    std::memcpy(&bytes[108], &offset, sizeof offset);
    EXPECT_EQ(readVolume(folder.write("v.nii", bytes)).grid.size, Size3(3, 4, 2)) << offset;
  }
}

TEST(NiftiHeader, NonFiniteTransformsAreRefused) {
  const TemporaryFolder folder;
  NiftiFile file;
  file.qformCode = file.sformCode = 1;
  const std::string good = file.bytes();
  for (const std::size_t at : {80u, 256u, 268u, 280u, 324u}) // pixdim, qform, sform
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(),
                            -std::numeric_limits<float>::infinity(), 1e38f}) {
      std::string bytes = good;
      std::memcpy(&bytes[at], &bad, sizeof bad);
      const auto path = folder.write("bad.nii", bytes);
      expectRefused(path, "invalid-field: qform, sform or pixdim", [&] { readVolume(path); });
    }
}

TEST(NiftiHeader, IntensityScalingIsApplied) {
  const TemporaryFolder folder;
  NiftiFile file;
  file.sformCode = 1;
  std::iota(file.samples.begin(), file.samples.end(), std::int16_t(0));
  std::string bytes = file.bytes();
  const std::array<float, 2> scaling = {2.0f, -1000.0f}; // slope, intercept
  std::memcpy(&bytes[112], scaling.data(), sizeof scaling);
  const Volume volume = readVolume(folder.write("scaled.nii", bytes));
  EXPECT_EQ(volume.minimum, -1000.0);
  EXPECT_EQ(std::get<LargeArray<std::int16_t>>(volume.voxels)[23], -954);
}

} // namespace
