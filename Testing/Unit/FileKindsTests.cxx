// NIfTI-2, pairs of files, Analyze and FreeSurfer volumes: geometry, samples, damaged files.

#include "NiftiKinds.h"
#include "Refusals.h"
#include "RunSettings.h"

#include "files/medical/ReferencedFiles.h"
#include "files/medical/VolumeReader.h"
#include "files/segments/SegmentationReader.h"

#include <gtest/gtest.h>

#include <random>

namespace fenestra::core::FileKindsTests {
namespace {

void expectVolume(const Volume& volume, const NiftiFile& file, const Affine& map) {
  ASSERT_EQ(volume.grid.size, Size3(file.size[0], file.size[1], file.size[2]));
  EXPECT_TRUE(volume.warnings.empty());
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 index = volume.grid.indexBox().corner(corner);
    EXPECT_LT((volume.grid.indexToWorld * index - map * index).norm(), 1e-4);
  }
  std::visit(
      [&](const auto& voxels) {
        for (std::size_t i = 0; i < voxels.size(); ++i)
          ASSERT_EQ(double(voxels[i]), file.samples[i]);
      },
      volume.voxels);
}

std::int16_t makeValue(const Size3& voxel) {
  return static_cast<std::int16_t>(voxel.x() + 3 * (voxel.y() + 4 * voxel.z()) - 7);
}

TEST(FileKinds, PlaceAllOrientationsAndKeepSamples) {
  const TemporaryFolder folder;
  std::array<int, 3> order = {0, 1, 2};
  do {
    for (int reversed = 0; reversed < 8; ++reversed) {
      Affine map;
      NiftiFile file = makeReordered({3, 4, 5}, {1.0, 2.0, 3.0}, {10.0, -20.0, 30.0}, makeValue,
                                     order, reversed, map);
      file.sformCode = 1;
      file.setSform(map);
      for (const std::endian bytes : {std::endian::little, std::endian::big})
        expectVolume(readVolume(folder.write("v.nii", makeNifti2(file, bytes))), file, map);
      expectVolume(readVolume(folder.write("v.mgh", makeMgh(file, map))), file, map);
      const Pair pair = makePair(file, "ni1");
      folder.write("v.hdr", pair.header);
      folder.write("v.img", pair.samples);
      expectVolume(readVolume(folder / "v.hdr"), file, map);
      expectVolume(readVolume(folder / "v.img"), file, map);
    }
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST(FileKinds, AnalyzeIsCenteredWithReversedXAndAWarning) {
  const TemporaryFolder folder;
  NiftiFile file;
  file.pixdim = {1, 2, 3, 4};
  file.samples[1] = 9;
  const Pair pair = makePair(file, std::string(3, '\0'));
  folder.write("v.hdr", pair.header);
  folder.write("v.img", pair.samples);
  const Volume volume = readVolume(folder / "v.hdr");
  EXPECT_LT((volume.grid.indexToWorld * Vec3(0, 0, 0) - Vec3(2.0, -4.5, -2.0)).norm(), 1e-6);
  EXPECT_LT((volume.grid.indexToWorld * Vec3(2, 3, 1) - Vec3(-2.0, 4.5, 2.0)).norm(), 1e-6);
  ASSERT_EQ(volume.warnings.size(), 1U);
  expectMessage(volume.warnings[0], "assumed-geometry");
}

TEST(FileKinds, MghWithoutDirectionsWarns) {
  const TemporaryFolder folder;
  std::string bytes = makeMgh(NiftiFile(), Affine::Identity());
  bytes[29] = 0;
  const Volume volume = readVolume(folder.write("v.mgh", bytes + "\1"));
  EXPECT_LT((volume.grid.indexToWorld * Vec3(1.5, 2.0, 1.0)).norm(), 1e-6);
  EXPECT_LT((volume.grid.indexToWorld.linear() * Vec3(0, 1, 0) - Vec3(0, 0, -1)).norm(), 1e-6);
  ASSERT_EQ(volume.warnings.size(), 1U);
  expectMessage(volume.warnings[0], "assumed-geometry");
}

TEST(FileKinds, NrrdWithoutAnatomicalSpaceWarns) {
  const TemporaryFolder folder;
  const std::string head = "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 1 1\nencoding: raw\n";
  const std::string axes = "space directions: (1,0,0) (0,1,0) (0,0,1)\n\n\1\2";
  for (const auto& [space, count] : {std::pair("space: left-posterior-superior\n", 0U),
                                     {"space: RAS\n", 0U},
                                     {"space: scanner-xyz\n", 0U},
                                     {"space: 3D-right-handed\n", 1U},
                                     {"space dimension: 3\n", 1U}}) {
    const Volume volume = readVolume(folder.write("v.nrrd", head + space + axes));
    ASSERT_EQ(volume.warnings.size(), count) << space;
    if (count > 0)
      expectMessage(volume.warnings[0], "assumed-geometry");
  }
}

TEST(FileKinds, SegmentationsUseFreeSurferNames) {
  const TemporaryFolder folder;
  NiftiFile file;
  file.samples[7] = 17; // Left-Hippocampus
  const auto path = folder.write("aseg.mgz", makeMgh(file, Affine::Identity()));
  const Segmentation labels = readSegmentation(path, nullptr, "freesurfer");
  ASSERT_EQ(labels.segments().size(), 1U);
  EXPECT_EQ(labels.segments()[0].name, "Left-Hippocampus");
}

TEST(FileKinds, PairsReferToEachOther) {
  const TemporaryFolder folder;
  const Pair pair = makePair(NiftiFile(), "ni1");
  const auto header = folder.write("v.HDR", pair.header);
  const auto missing = std::filesystem::path(header).replace_extension(".IMG");
  expectRefused(header, "invalid-field | v.IMG", [&] { readVolume(header); });
  const auto samples = folder.write("v.IMG", pair.samples);
  EXPECT_EQ(missing, samples);
  EXPECT_EQ(findReferencedFiles(header), std::vector{samples});
  EXPECT_EQ(findReferencedFiles(samples), std::vector{header});
  const auto single = folder.write("one.nii", pair.header + std::string(4, '\0') + pair.samples);
  expectRefused(single, "unsupported-file", [&] { readVolume(single); });
}

/// Truncations and random bytes give an Error or a volume.
TEST(FileKinds, DamagedFilesAreRefusedOrRead) {
  const TemporaryFolder folder;
  NiftiFile file;
  file.sformCode = 1;
  const Pair pair = makePair(file, "ni1");
  folder.write("p.img", pair.samples);
  const auto read = [&](const std::string& name, const std::string& bytes) {
    const auto path = folder.write(name, bytes);
    try {
      return readVolume(path).grid.voxelCount() > 0;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input);
      return false;
    }
  };
  std::mt19937 random(1);
  for (const auto& [name, bytes] : {std::pair("v.nii", makeNifti2(file, std::endian::little)),
                                    {"v.mgh", makeMgh(file, Affine::Identity())},
                                    {"v.mgz", makeMgh(file, Affine::Identity())},
                                    {"p.hdr", pair.header}}) {
    EXPECT_TRUE(read(name, bytes)) << name;
    for (std::size_t size = 0; size < bytes.size();
         size += fenestra::core::testing::isLongRun() ? 1 : 7)
      EXPECT_FALSE(read(name, bytes.substr(0, size))) << name << " of " << size << " bytes";
    const int flips = fenestra::core::testing::scaleSamples(250);
    for (int i = 0; i < flips; ++i) {
      std::string damaged = bytes;
      for (auto n = 1 + random() % 3; n > 0; --n)
        damaged[random() % damaged.size()] = static_cast<char>(random());
      read(name, damaged);
    }
  }
}

} // namespace
} // namespace fenestra::core::FileKindsTests
