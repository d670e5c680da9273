// One frame of several: NIfTI, NRRD and MetaImage.

#include "Approx.h"
#include "MedicalFiles.h"
#include "NiftiFile.h"

#include "files/medical/VolumeReader.h"

#include <zlib.h>

#include <numeric>

namespace fenestra::core::FrameTests {
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

/// NRRD of 2 x 1 x 3 mm; the first voxel is at (-1, -2, 3), RAS. `fields`: those of its space.
std::string makeTimed(const std::string& fields, bool isInterleaved, bool isCompressed = false,
                      const std::string& more = "type: short\nendian: little\n") {
  const std::string samples = rawBytes(makeFrames(isInterleaved));
  return "NRRD0005\ndimension: 4\n" + more + "encoding: " + (isCompressed ? "gzip" : "raw") + "\n" +
         fields + "\n" + (isCompressed ? compress(samples) : samples);
}

struct TimedNrrd {
  std::string space, directions, origin, kinds;
  bool isFirst = false; ///< time is the first axis

  std::string fields() const {
    return "space" + space + "\nspace directions: " + directions + "\nspace origin: " + origin +
           "\nsizes: " + (isFirst ? "5 3 4 2" : "3 4 2 5") + "\n" +
           (kinds.empty() ? "" : "kinds: " + kinds + "\n");
  }
};

TEST(Frames, NrrdWithATimeAxisInSpaceGivesFrames) {
  const std::string lps = ": left-posterior-superior", three = "(2,0,0) (0,1,0) (0,0,3)",
                    four = "(2,0,0,0) (0,1,0,0) (0,0,3,0)", time = "(0,0,0,1.5)";
  const std::vector<TimedNrrd> files = {
      {lps, three + " none", "(1,2,3)", "domain domain domain time"},
      {lps, "none " + three, "(1,2,3)", "time domain domain domain", true},
      {lps, three + " none", "(1,2,3)", "space space space none"},
      {lps, three + " none", "(1,2,3)", "domain domain domain ???"},
      {lps, three + " none", "(1,2,3)", ""},
      {lps, "none " + three, "(1,2,3)", "", true},
      {": LAS", "(2,0,0) (0,-1,0) (0,0,3) none", "(1,-2,3)", "domain domain domain time"},
      {": right-anterior-superior", "none (-2,0,0) (0,-1,0) (0,0,3)", "(-1,-2,3)", "", true},
      {lps + "-time", four + " " + time, "(1,2,3,0)", "domain domain domain time"},
      {lps + "-time", time + " " + four, "(1,2,3,0)", "time domain domain domain", true},
      {": LPST", four + " " + time, "(1,2,3,0)", ""},
      {": RAST", "(-2,0,0,0) (0,-1,0,0) (0,0,3,0) " + time, "(-1,-2,3,0)", ""}};
  const TemporaryFolder folder;
  for (const TimedNrrd& file : files)
    for (const bool isCompressed : {false, true}) {
      const auto path =
          folder.write("v.nrrd", makeTimed(file.fields(), file.isFirst, isCompressed));
      expectEachFrame(path);
      const Affine map = readVolume(path).grid.indexToWorld;
      EXPECT_TRUE(isApprox(map * Vec3(0, 0, 0), Vec3(-1, -2, 3), 1e-4)) << file.fields();
      EXPECT_TRUE(isApprox(map * Vec3(2, 3, 1), Vec3(-5, -5, 6), 1e-4)) << file.fields();
    }
}

TEST(Frames, TimeAxisWithoutAnatomicalSpaceGivesAWarning) {
  const TemporaryFolder folder;
  const TimedNrrd space{" dimension: 3", "(2,0,0) (0,1,0) (0,0,3) none", "(1,2,3)",
                        "space space space time"};
  expectEachFrame(folder.write("d.nrrd", makeTimed(space.fields(), false)), 1);
  const std::string fields = "sizes: 5 3 4 2\nkinds: time domain domain domain\n";
  const auto path = folder.write("s.nrrd", makeTimed(fields + "spacings: 1 2 1 3\n", true));
  expectEachFrame(path, 1);
  EXPECT_TRUE(isApprox(readVolume(path).grid.spacing(), Vec3(2, 1, 3), 1e-9));
  const auto bare = folder.write("b.nrrd", makeTimed(fields, true));
  expectEachFrame(bare, 1);
  EXPECT_TRUE(
      isApprox(readVolume(bare, {.spacing = Vec3(2, 1, 3)}).grid.spacing(), Vec3(2, 1, 3), 1e-9));
}

TEST(Frames, TimeAxesThatCannotBeReadAreRefused) {
  const TemporaryFolder folder;
  const TimedNrrd good{": left-posterior-superior", "(2,0,0) (0,1,0) (0,0,3) none", "(1,2,3)",
                       "domain domain domain time"};
  const auto expectRefusal = [&](const std::string& text, const std::string& expected) {
    const auto path = folder.write("v.nrrd", text);
    expectRefused(path, expected, [&] { readVolume(path, {.frame = 0}); });
  };
  TimedNrrd file = good;
  file.directions = "(2,0,0) none (0,1,0) (0,0,3)";
  file.kinds = "domain time domain domain";
  expectRefusal(makeTimed(file.fields(), false), "unsupported-file | 2");
  file = good;
  file.directions = "(2,0,0) none none (0,0,3)";
  expectRefusal(makeTimed(file.fields(), false), "invalid-field: space directions");
  file = good;
  file.directions = "(2,0) (0,1) (3,3) none";
  expectRefusal(makeTimed(file.fields(), false), "invalid-field: space directions");
  file = good;
  file.directions = "(2,0,0) (2,0,0) (0,0,3) none";
  expectRefusal(makeTimed(file.fields(), false), "invalid-field: directions");
  for (const char* spacings : {"1 2 1", "1 -2 1 3", "1 0 1 3"})
    expectRefusal(makeTimed(std::string("sizes: 5 3 4 2\nkinds: time domain domain domain\n"
                                        "spacings: ") +
                                spacings + "\n",
                            true),
                  "invalid-field: spacings");
  const std::string whole = makeTimed(good.fields(), false);
  expectRefusal(whole.substr(0, whole.size() - 1), "damaged-file | 240 bytes");
  const std::string packed = makeTimed(good.fields(), false, true);
  expectRefusal(packed.substr(0, packed.size() / 2), "");
  expectRefusal(makeTimed(good.fields(), false, false, "type: short\n"), "unsupported-file");
  expectRefusal(makeTimed(good.fields(), false, false, "type: block\nendian: little\n"),
                "invalid-field: type");
  std::string huge = whole;
  huge.replace(huge.find("sizes: 3 4 2 5"), 14, "sizes: 2147483647 2147483647 2147483647 5");
  expectRefusal(huge, "damaged-file");
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
} // namespace fenestra::core::FrameTests
