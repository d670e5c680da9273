// One frame of several: NIfTI, NRRD and MetaImage.

#include "MedicalFiles.h"
#include "NiftiFile.h"

#include "files/medical/VolumeReader.h"

#include <zlib.h>

#include <numeric>

namespace fenestra::FrameTests {
namespace {

constexpr std::size_t frames = 5, voxels = 24;

std::int16_t frameValue(std::size_t frame, std::size_t voxel) {
  return static_cast<std::int16_t>(100 * frame + voxel);
}

/// Samples of all frames, one after the other or interleaved.
std::vector<std::int16_t> makeFrames(bool isInterleaved) {
  std::vector<std::int16_t> samples(frames * voxels);
  for (std::size_t frame = 0; frame < frames; ++frame)
    for (std::size_t voxel = 0; voxel < voxels; ++voxel)
      samples[isInterleaved ? voxel * frames + frame : frame * voxels + voxel] =
          frameValue(frame, voxel);
  return samples;
}

std::string makeNifti() {
  NiftiFile file;
  file.sformCode = 1;
  file.samples = makeFrames(false);
  std::string bytes = file.bytes();
  const std::array<std::int16_t, 5> axes = {4, 3, 4, 2, frames};
  std::memcpy(&bytes[40], axes.data(), sizeof axes);
  return bytes;
}

std::string compress(const std::string& bytes) {
  std::string packed(compressBound(uLong(bytes.size())) + 32, '\0');
  z_stream stream{};
  deflateInit2(&stream, 9, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY); // gzip
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  deflate(&stream, Z_FINISH);
  deflateEnd(&stream);
  packed.resize(stream.total_out);
  return packed;
}

/// `sizes` and `kinds`: one word per axis.
std::string makeNrrd(const std::string& sizes, const std::string& kinds, bool isCompressed,
                     bool isInterleaved) {
  const std::string samples = rawBytes(makeFrames(isInterleaved));
  return "NRRD0004\ntype: short\ndimension: 4\nspace: left-posterior-superior\nsizes: " + sizes +
         "\nspace directions: " +
         (kinds.starts_with("domain") ? "(1,0,0) (0,1,0) (0,0,1) none"
                                      : "none (1,0,0) (0,1,0) (0,0,1)") +
         "\nkinds: " + kinds + "\nendian: little\nencoding: " + (isCompressed ? "gzip" : "raw") +
         "\nspace origin: (0,0,0)\n\n" + (isCompressed ? compress(samples) : samples);
}

/// `assumptions`: other warnings than that of the frame.
void expectEachFrame(const std::filesystem::path& path, std::size_t assumptions = 0) {
  for (std::size_t frame = 0; frame < frames; ++frame) {
    const Volume volume = readVolume(path, {.frame = frame});
    EXPECT_EQ(volume.grid.size, Size3(3, 4, 2)) << path;
    EXPECT_EQ(volume.frameCount, frames) << path;
    EXPECT_EQ(volume.warnings.size(), assumptions) << path;
    std::visit(
        [&](const auto& all) {
          ASSERT_EQ(all.size(), voxels);
          for (std::size_t voxel = 0; voxel < voxels; ++voxel)
            EXPECT_EQ(double(all[voxel]), frameValue(frame, voxel)) << path;
        },
        volume.voxels);
  }
  const Volume first = readVolume(path);
  EXPECT_EQ(first.maximum, frameValue(0, voxels - 1)) << path;
  ASSERT_EQ(first.warnings.size(), assumptions + 1) << path;
  expectMessage(first.warnings.back(), "assumed-frame | 5 frames");
  expectRefused(path, "unknown-frame | 5", [&] { readVolume(path, {.frame = frames}); });
}

TEST(Frames, FourthAxisHoldsFrames) {
  const TemporaryFolder folder;
  expectEachFrame(folder.write("v.nii", makeNifti()));
  expectEachFrame(folder.write("v.nii.gz", compress(makeNifti())));
  for (const char* name : {"v.nrrd", "v.mha"})
    for (const bool isCompressed : {false, true}) {
      writeFile(folder / name, makeFrames(false),
                {.size = {3, 4, 2, frames},
                 .directions = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}},
                 .spacing = {1, 1, 1, 1},
                 .origin = {0, 0, 0, 0},
                 .compress = isCompressed});
      expectEachFrame(folder / name, name == std::string("v.nrrd") ? 1 : 0); // no space
    }
}

TEST(Frames, NrrdListHoldsFramesFirstOrLast) {
  const TemporaryFolder folder;
  for (const bool isCompressed : {false, true}) {
    expectEachFrame(folder.write(
        "first.nrrd", makeNrrd("5 3 4 2", "list domain domain domain", isCompressed, true)));
    expectEachFrame(folder.write(
        "last.nrrd", makeNrrd("3 4 2 5", "domain domain domain list", isCompressed, false)));
  }
}

TEST(Frames, TruncatedFramesAreRefusedWhicheverIsRead) {
  const TemporaryFolder folder;
  const std::string nifti = makeNifti();
  const auto path = folder.write("v.nii", nifti.substr(0, nifti.size() - 2));
  expectRefused(path, "damaged-file", [&] { readVolume(path, {.frame = 0}); });
}

TEST(Frames, ColorsAndComplexNumbersAreNoFrames) {
  const TemporaryFolder folder;
  for (const char* kind : {"RGB-color", "3-color", "RGBA-color", "4-color", "vector"}) {
    const bool hasAlpha = std::string(kind).find_first_of("4A") != std::string::npos;
    std::string text = makeNrrd(hasAlpha ? "4 3 4 2" : "3 3 4 2",
                                std::string(kind) + " domain domain domain", false, true);
    const auto path = folder.write("v.nrrd", text);
    expectRefused(path, "unsupported-file", [&] { readVolume(path, {.frame = 1}); });
  }
  for (const auto code : std::to_array<std::int16_t>({128, 2304, 32, 1792})) {
    std::string bytes = makeNifti();
    std::memcpy(&bytes[70], &code, sizeof code);
    const auto path = folder.write("v.nii", bytes);
    expectRefused(path, "unsupported-file", [&] { readVolume(path); });
  }
}

} // namespace
} // namespace fenestra::FrameTests
