// Round trips through every file format and sample type; invalid files.

#include "files/medical/VolumeReader.h"

#include "Approx.h"
#include "MedicalFiles.h"

#include <numeric>

namespace fenestra::core::VolumeReaderTests {
namespace {

template <typename Stored>
const LargeArray<Stored>& getVoxels(const Volume& volume) {
  return std::get<LargeArray<Stored>>(volume.voxels);
}

/// Linear ramp of 24 samples, the number of the default geometry.
template <typename T>
std::vector<T> makeRamp(double first, double step) {
  std::vector<T> samples(24);
  for (std::size_t i = 0; i < samples.size(); ++i)
    samples[i] = static_cast<T>(first + step * static_cast<double>(i));
  return samples;
}

template <typename Stored, typename T>
void expectRoundTrip(const std::vector<T>& samples) {
  const TemporaryFolder folder;
  for (const char* name : {"v.nrrd", "v.nhdr", "v.nii", "v.nii.gz", "v.mha", "v.mhd"})
    for (const bool compress : {false, true}) {
      if (std::string(name).starts_with("v.nii") && sizeof(T) == 8 && std::is_integral_v<T>)
        continue; // ITK does not write 64-bit integers to NIfTI
      const auto path = folder / name;
      writeFile(path, samples, {.compress = compress});
      const Volume volume = readVolume(path);
      ASSERT_TRUE(std::holds_alternative<LargeArray<Stored>>(volume.voxels)) << name;
      ASSERT_EQ(getVoxels<Stored>(volume).size(), samples.size());
      for (std::size_t i = 0; i < samples.size(); ++i)
        ASSERT_EQ(static_cast<double>(getVoxels<Stored>(volume)[i]),
                  static_cast<double>(samples[i]))
            << name;
      const auto [low, high] = std::minmax_element(samples.begin(), samples.end());
      EXPECT_EQ(volume.minimum, static_cast<double>(*low));
      EXPECT_EQ(volume.maximum, static_cast<double>(*high));
      EXPECT_TRUE(volume.warnings.empty());
      EXPECT_EQ(volume.grid.size, Size3(3, 4, 2));
    }
}

TEST(VolumeReader, StoresSamplesInTheSmallestType) {
  expectRoundTrip<std::uint8_t>(makeRamp<std::int8_t>(0, 5));
  expectRoundTrip<std::int16_t>(makeRamp<std::int8_t>(-100, 5));
  expectRoundTrip<std::uint8_t>(makeRamp<std::uint8_t>(3, 10));
  expectRoundTrip<std::int16_t>(makeRamp<std::int16_t>(-1024, 170));
  expectRoundTrip<std::uint16_t>(makeRamp<std::uint16_t>(0, 2800));
  expectRoundTrip<std::int16_t>(makeRamp<std::uint16_t>(0, 1000));
  expectRoundTrip<std::int16_t>(makeRamp<std::int32_t>(-1024, 170));
  expectRoundTrip<float>(makeRamp<std::int32_t>(-100000, 9000));
  expectRoundTrip<std::uint16_t>(makeRamp<std::uint32_t>(0, 2800));
  expectRoundTrip<std::int16_t>(makeRamp<std::int64_t>(-30000, 2000));
  expectRoundTrip<float>(makeRamp<std::int64_t>(-65536.0 * 65536.0, 65536.0));
  expectRoundTrip<std::uint8_t>(makeRamp<std::uint64_t>(0, 11));
  expectRoundTrip<float>(makeRamp<float>(-0.5, 0.25));
  expectRoundTrip<std::int16_t>(makeRamp<float>(-1024, 100));
  expectRoundTrip<float>(makeRamp<double>(-0.5, 0.25));
  expectRoundTrip<std::uint8_t>(makeRamp<double>(0, 1));
}

TEST(VolumeReader, RoundsDoublesToFloats) {
  const TemporaryFolder folder;
  auto samples = makeRamp<double>(0.1, 1);
  samples[3] = 1e300;
  samples[4] = -1e300;
  writeFile(folder / "v.nrrd", samples);
  const Volume volume = readVolume(folder / "v.nrrd");
  EXPECT_EQ(getVoxels<float>(volume)[0], 0.1f);
  EXPECT_EQ(volume.maximum, double(std::numeric_limits<float>::max()));
  EXPECT_EQ(volume.minimum, -double(std::numeric_limits<float>::max()));
}

TEST(VolumeReader, ReplacesNonFiniteVoxels) {
  const TemporaryFolder folder;
  for (const char* name : {"v.nrrd", "v.nii.gz", "v.mha"})
    for (const double step : {0.5, 1.0}) { // stays float; can be stored as integers
      auto samples = makeRamp<float>(-3, step);
      samples[5] = std::numeric_limits<float>::quiet_NaN();
      samples[6] = std::numeric_limits<float>::infinity();
      samples[7] = -std::numeric_limits<float>::infinity();
      writeFile(folder / name, samples);
      const Volume volume = readVolume(folder / name);
      std::visit(
          [&](const auto& voxels) {
            EXPECT_EQ(double(voxels[5]), -3.0) << name;
            EXPECT_EQ(double(voxels[6]), -3 + 23 * step);
            EXPECT_EQ(double(voxels[7]), -3.0);
            EXPECT_EQ(double(voxels[8]), -3 + 8 * step);
          },
          volume.voxels);
      ASSERT_EQ(volume.warnings.size(), 2u);
      expectMessage(volume.warnings[0], "non-finite-voxels | 1 voxels");
      expectMessage(volume.warnings[1], "non-finite-voxels | 2 voxels");
    }
}

TEST(VolumeReader, ConvertsObliqueGeometryToRas) {
  const TemporaryFolder folder;
  const double c = std::cos(0.3), s = std::sin(0.3);
  FileGeometry geometry{.directions = {{c, s, 0}, {-s, c, 0}, {0, 0, 1}},
                        .spacing = {0.5, 0.75, 3},
                        .origin = {10, -20, 30}};
  for (const bool leftHanded : {false, true}) {
    geometry.directions[2] = {0, 0, leftHanded ? -1.0 : 1.0};
    for (const char* name : {"v.nrrd", "v.nii", "v.nii.gz", "v.mha", "v.mhd"}) {
      writeFile(folder / name, makeRamp<std::uint8_t>(0, 1), geometry);
      const Grid grid = readVolume(folder / name).grid;
      const Vec3 index(2, 3, 1);
      const Vec3 lps = Vec3(10, -20, 30) + index[0] * 0.5 * Vec3(c, s, 0) +
                       index[1] * 0.75 * Vec3(-s, c, 0) +
                       index[2] * 3.0 * Vec3(0, 0, leftHanded ? -1 : 1);
      EXPECT_TRUE(isApprox(grid.indexToWorld * index, Vec3(-lps.x(), -lps.y(), lps.z()), 1e-6))
          << name << " " << (grid.indexToWorld * index);
      EXPECT_TRUE(isApprox(grid.worldToIndex * (grid.indexToWorld * index), index, 1e-6));
      EXPECT_TRUE(isApprox(grid.spacing(), Vec3(0.5, 0.75, 3), 1e-6)) << name;
    }
  }
}

/// Text of a raw NRRD; `head`: the fields that differ between tests.
std::string makeNrrd(const std::string& head, const std::string& data,
                     const std::string& encoding = "raw") {
  return "NRRD0004\ntype: unsigned char\nencoding: " + encoding + "\n" + head + "\n\n" + data;
}

TEST(VolumeReader, ReadsRasSpaceAndShearedAxes) {
  const TemporaryFolder folder;
  const std::string samples(24, 'x');
  const auto path = folder.write(
      "ras.nrrd", makeNrrd("dimension: 3\nspace: right-anterior-superior\nsizes: 3 4 2\n"
                           "space directions: (2,0,0) (0.5,1,0) (0,0,-3)\nspace origin: (1,2,3)",
                           samples));
  const Grid grid = readVolume(path).grid;
  EXPECT_TRUE(isApprox(grid.indexToWorld * Vec3(1, 1, 1), Vec3(3.5, 3, 0), 1e-12));
  EXPECT_LT(grid.indexToWorld.linear().determinant(), 0.0);
  const auto lps = folder.write(
      "lps.nrrd", makeNrrd("dimension: 3\nspace: left-posterior-superior\nsizes: 3 4 2\n"
                           "space directions: (-2,0,0) (0,-1,0) (0,0,3)\nspace origin: (1,2,3)",
                           samples));
  EXPECT_TRUE(isApprox(readVolume(lps).grid.indexToWorld * Vec3(1, 1, 1), Vec3(1, -1, 6), 1e-12));
}

TEST(VolumeReader, ReadsDetachedDataAndFileLists) {
  const TemporaryFolder folder;
  const std::string head = "dimension: 3\nsizes: 3 4 2\n";
  folder.write("half.raw", std::string(12, '\1'));
  folder.write("whole.raw", std::string(24, '\2'));
  const auto one = folder.write("one.nhdr", makeNrrd(head + "data file: whole.raw", ""));
  EXPECT_EQ(readVolume(one).minimum, 2.0);
  const auto list = folder.write("list.nhdr", "NRRD0004\ntype: unsigned char\nencoding: raw\n" +
                                                  head + "data file: LIST 2\nhalf.raw\nhalf.raw\n");
  EXPECT_EQ(readVolume(list).maximum, 1.0);
}

TEST(VolumeReader, ReadsAsciiAndHexEncoding) {
  const TemporaryFolder folder;
  const std::string head = "NRRD0004\ntype: double\ndimension: 3\nsizes: 2 2 1\nendian: little\n";
  const auto text = folder.write("a.nrrd", head + "encoding: ascii\n\n1 2 3 4\n");
  EXPECT_EQ(readVolume(text).maximum, 4.0);
  std::string hex;
  for (int i = 0; i < 4; ++i)
    hex += "000000000000f03f"; // 1.0
  EXPECT_EQ(readVolume(folder.write("h.nrrd", head + "encoding: hex\n\n" + hex)).minimum, 1.0);
}

TEST(VolumeReader, DropsTrailingAxesOfSizeOne) {
  const TemporaryFolder folder;
  const auto path = folder.write(
      "legacy.nrrd",
      makeNrrd("dimension: 4\nspace dimension: 4\nsizes: 3 4 2 1\nkinds: domain domain "
               "domain domain\nspace directions: (-2,0,0,0) (0,-1,0,0) (0,0,3,0) "
               "(0,0,0,1)\nspace origin: (1,2,3,0)",
               std::string(24, 'x')));
  const Volume volume = readVolume(path);
  EXPECT_EQ(volume.grid.size, Size3(3, 4, 2));
  EXPECT_TRUE(isApprox(volume.grid.indexToWorld * Vec3(1, 1, 1), Vec3(1, -1, 6), 1e-12));
  writeFile(folder / "slice.nrrd", std::vector<std::uint8_t>(12, 1), {.size = {3, 4, 1}});
  EXPECT_EQ(readVolume(folder / "slice.nrrd").grid.size, Size3(3, 4, 1));
}

void expectRefusal(const std::filesystem::path& path, const std::string& text) {
  expectRefused(path, text, [&path] { readVolume(path); });
}

TEST(VolumeReader, RefusesVectorsAndImages) {
  const TemporaryFolder folder;
  const std::vector<std::uint8_t> samples(96, 1);
  for (const std::string end : {".nrrd", ".nii.gz", ".mha"}) {
    writeFile(folder / ("vectors" + end), samples, {.components = 3});
    expectRefusal(folder / ("vectors" + end), "unsupported-file | 3");
  }
  for (const std::string end : {".nrrd", ".mha"}) {
    writeFile(folder / ("flat" + end), samples, {.size = {3, 4}});
    expectRefusal(folder / ("flat" + end), "unsupported-file");
  }
}

TEST(VolumeReader, RefusesMissingAndUnknownFiles) {
  const TemporaryFolder folder;
  expectRefusal(folder / "missing.nrrd", "missing-file");
  expectRefusal(folder / "", "not-a-file");
  expectRefusal(folder.write("volume.dat", "x"), "unsupported-file");
  for (const char* name : {"a.nrrd", "a.nhdr", "a.nii", "a.nii.gz", "a.mha", "a.mhd"}) {
    for (const std::string& bytes : {std::string(), std::string("something else\nentirely\n"),
                                     std::string(5000, '\0'), std::string(5000, '\xff')})
      expectRefusal(folder.write(name, bytes), "");
  }
}

TEST(VolumeReader, SaysWhatMisnamedFilesAre) {
  const TemporaryFolder folder;
  const auto expectHint = [&](const char* name, const std::string& bytes, const std::string& hint) {
    expectRefusal(folder.write(name, bytes), "damaged-file | " + hint);
  };
  const std::string pointer = "version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 9\n";
  for (const char* name : {"v.nii.gz", "v.nii", "v.nrrd", "v.mha"}) {
    expectHint(name, pointer, "git lfs pull");
    expectHint(name, "\n <!DOCTYPE html><html></html>", "web page");
  }
  writeFile(folder / "v.nii.gz", std::vector<std::uint8_t>(24), {.size = {3, 4, 2}});
  expectHint("packed.nii", readBytes(folder / "v.nii.gz"), "packed.nii.gz");
  writeFile(folder / "v.nii", std::vector<std::uint8_t>(24), {.size = {3, 4, 2}});
  expectHint("plain.nii.gz", readBytes(folder / "v.nii"), "name it plain.nii");
}

TEST(VolumeReader, RefusesTruncatedFiles) {
  const TemporaryFolder folder;
  std::vector<std::uint16_t> samples(8000);
  for (std::size_t i = 0; i < samples.size(); ++i) // incompressible
    samples[i] = static_cast<std::uint16_t>(i * i * 40503u);
  for (const char* name : {"v.nrrd", "v.nii", "v.nii.gz", "v.mha"})
    for (const bool compress : {false, true}) {
      writeFile(folder / name, samples, {.size = {20, 20, 20}, .compress = compress});
      const std::string complete = readBytes(folder / name);
      for (const double fraction : {0.02, 0.3, 0.9, 0.999})
        expectRefusal(
            folder.write(std::string("cut-") + name,
                         complete.substr(0, std::size_t(fraction * double(complete.size())))),
            "");
    }
  for (const bool compress : {false, true}) {
    writeFile(folder / "v.mhd", samples, {.size = {20, 20, 20}, .compress = compress});
    const std::string data = readBytes(folder / (compress ? "v.zraw" : "v.raw"));
    folder.write(compress ? "v.zraw" : "v.raw", data.substr(0, data.size() - 9));
    expectRefusal(folder / "v.mhd", "damaged-file");
  }
}

TEST(VolumeReader, RefusesDamagedStreams) {
  const TemporaryFolder folder;
  std::vector<std::uint16_t> samples(8000);
  for (std::size_t i = 0; i < samples.size(); ++i)
    samples[i] = static_cast<std::uint16_t>(i * i * 40503u);
  for (const char* name : {"v.nrrd", "v.mha"}) {
    writeFile(folder / name, samples, {.size = {20, 20, 20}, .compress = true});
    std::string bytes = readBytes(folder / name);
    for (std::size_t i = bytes.size() / 2; i < bytes.size() / 2 + 40; ++i)
      bytes[i] = static_cast<char>(~bytes[i]);
    expectRefusal(folder.write(name, bytes), "");
  }
}

TEST(VolumeReader, RefusesSizesThatTheFileCannotHold) {
  const TemporaryFolder folder;
  const auto writeSized = [&](const std::string& sizes, const std::string& encoding) {
    return folder.write("huge.nrrd", makeNrrd("dimension: 3\nsizes: " + sizes, "xxxx", encoding));
  };
  for (const char* encoding : {"raw", "gzip", "ascii", "hex"}) {
    expectRefusal(writeSized("100000 100000 100000", encoding), "damaged-file");
    expectRefusal(writeSized("2147483647 2147483647 2147483647", encoding), "");
    expectRefusal(writeSized("4294967297 1 4", encoding), "invalid-field: sizes");
    expectRefusal(writeSized("3 0 4", encoding), "invalid-field: sizes");
    expectRefusal(writeSized("3 -4 4", encoding), "invalid-field: sizes");
  }
  const auto writeMeta = [&](const std::string& size, const std::string& more) {
    return folder.write("huge.mha", "ObjectType = Image\nNDims = 3\nDimSize = " + size + "\n" +
                                        more +
                                        "ElementType = MET_DOUBLE\nElementDataFile = LOCAL\nxxxx");
  };
  expectRefusal(writeMeta("2000000 2000000 2000000", ""), "damaged-file");
  expectRefusal(writeMeta("2000000 2000000 2000000", "CompressedData = True\n"), "damaged-file");
  expectRefusal(writeMeta("100 100", ""), "invalid-field: DimSize");
  expectRefusal(writeMeta("3 3 3\nNDims = 4000", ""), "invalid-field: NDims");
  expectRefusal(writeMeta("3 3 3\nNDims" + std::string(1, '\0') + " = -1\nDimSize = 1", ""),
                "damaged-file");
  // MetaIO does not terminate after such fields.
  expectRefusal(writeMeta("3 3 3\nElementSpacing: 1 = 1", ""), "damaged-file");
  expectRefusal(writeMeta("3 3 3\nComment = a\x05"
                          "b",
                          ""),
                "damaged-file");
  expectRefusal(writeMeta("3 3 3\nComment = " + std::string(3000, 'c'), ""),
                "invalid-field: Comment");
  expectRefusal(writeMeta("1 1 1\nTransformMatrix = 1 0", ""), "invalid-field: TransformMatrix");
  writeFile(folder / "v.nii", makeRamp<float>(0, 1));
  std::string nifti = readBytes(folder / "v.nii");
  for (const std::size_t axis : {1u, 2u, 3u}) { // dim[] starts at byte 40, two bytes per entry
    nifti[40 + 2 * axis] = '\xff';
    nifti[41 + 2 * axis] = '\x7f';
  }
  expectRefusal(folder.write("huge.nii", nifti), "damaged-file");
}

/// Teem, ITK's NRRD library, copies lines, names and numbers to buffers of 1024 bytes, and sizes to
/// one of 16 entries, without checking their length.
TEST(VolumeReader, RefusesNrrdHeadersThatCrashTeem) {
  const TemporaryFolder folder;
  const std::string sizes = "dimension: 3\nsizes: 3 4 2\n";
  const std::string samples(24, 'x');
  const auto writeWithLine = [&](const std::string& line) {
    return folder.write("v.nrrd", makeNrrd(sizes + line, samples));
  };
  for (const std::string& line :
       {std::string(1000, 'x'), "kinds: " + std::string(1000, 'x'), "#" + std::string(1000, 'x'),
        std::string(1000, 'x') + ": y", "a: " + std::string(1000, 'x') + ":=b"})
    expectRefusal(writeWithLine(line), "invalid-field: header | line 6 | 500");
  EXPECT_EQ(readVolume(writeWithLine("key:=" + std::string(100'000, 'x'))).maximum, 'x');
  for (const char control : {'\0', '\x01', '\r', '\x7f'})
    expectRefusal(writeWithLine(std::string(400, 'x') + control + ":=" + std::string(400, 'x')),
                  "damaged-file");
  expectRefusal(folder.write("v.nrrd", "NRRD0004" + std::string(2000, 'x') + "\n" + sizes), "");
  expectRefusal(writeWithLine("data file: LIST\n" + std::string(1000, 'x')),
                "invalid-field: header | 500");
  expectRefusal(writeWithLine("dimension: 3"), "invalid-field: dimension");
  expectRefusal(writeWithLine("datafile: v.nrrd\nData file: v.nrrd"), "invalid-field: datafile");
  std::string many = "dimension: 16\nsizes:";
  for (int axis = 0; axis < 17; ++axis)
    many += " 1";
  expectRefusal(folder.write("v.nrrd", makeNrrd(many, samples)), "invalid-field: dimension");
  expectRefusal(folder.write("a.nrrd", makeNrrd(sizes, std::string(2000, '1') + " 1", "ascii")),
                "invalid-field: samples | 500");
  std::string deep = folder.path().string();
  for (int level = 0; level < 5; ++level)
    deep += "/" + std::string(200, 'd');
  std::filesystem::create_directories(deep);
  std::ofstream(deep + "/v.nrrd") << makeNrrd("x", samples);
  expectRefusal(deep + "/v.nrrd", "limit-exceeded | 900");
}

TEST(VolumeReader, RefusesNrrdHeadersWithTooManyLines) {
  const TemporaryFolder folder;
  const auto writeLines = [&](int lines) {
    std::string head = "dimension: 3\nsizes: 3 4 2\n";
    for (int i = 0; i < lines; ++i)
      head += "key" + std::to_string(i) + ":=value\n";
    return folder.write("v.nrrd", makeNrrd(head.substr(0, head.size() - 1), std::string(24, 'x')));
  };
  EXPECT_EQ(readVolume(writeLines(9'900)).maximum, 'x');
  expectRefusal(writeLines(100'000), "invalid-field: header | 10000");
}

TEST(VolumeReader, RefusesSingularGeometry) {
  const TemporaryFolder folder;
  const auto writeOriented = [&](const std::string& directions, const std::string& origin) {
    return folder.write("v.nrrd",
                        makeNrrd("dimension: 3\nspace: left-posterior-superior\nsizes: 3 4 2\n"
                                 "space directions: " +
                                     directions + "\nspace origin: " + origin,
                                 std::string(24, 'x')));
  };
  expectRefusal(writeOriented("(1,0,0) (2,0,0) (0,0,1)", "(0,0,0)"), "invalid-field: directions");
  expectRefusal(writeOriented("(1,0,0) (0,0,0) (0,0,1)", "(0,0,0)"), "");
  expectRefusal(writeOriented("(1,0,0) (0,inf,0) (0,0,1)", "(0,0,0)"), "");
  expectRefusal(writeOriented("(1,0,0) (nan,nan,nan) (0,0,1)", "(0,0,0)"), "");
  expectRefusal(writeOriented("(1,0,0) (0,1,0) (0,0,1)", "(0,1e300,0)"), "invalid-field: origin");
  for (const char* spacings : {"1 0 1", "1 -1 1", "1 inf 1"})
    expectRefusal(
        folder.write("s.nrrd",
                     makeNrrd(std::string("dimension: 3\nsizes: 3 4 2\nspacings: ") + spacings,
                              std::string(24, 'x'))),
        "");
  for (const char* spacing : {"1 0 1", "1 -1 1"})
    expectRefusal(
        folder.write("s.mha", std::string("ObjectType = Image\nNDims = 3\nDimSize = 3 4 2\n"
                                          "ElementSpacing = ") +
                                  spacing + "\nElementType = MET_UCHAR\nElementDataFile = LOCAL\n" +
                                  std::string(24, 'x')),
        "invalid-field: spacing");
}

TEST(VolumeReader, RefusesVolumesWithoutAFiniteVoxel) {
  const TemporaryFolder folder;
  writeFile(folder / "v.nrrd", std::vector<double>(24, std::nan("")));
  expectRefusal(folder / "v.nrrd", "non-finite-voxels");
}

TEST(VolumeReader, RefusesInvalidDataFiles) {
  const TemporaryFolder folder;
  for (const char* name : {"-", "/dev/zero", ".", "missing.raw", "part%03d.raw 1 9 1"})
    expectRefusal(
        folder.write("v.nhdr",
                     makeNrrd(std::string("dimension: 3\nsizes: 3 4 2\ndata file: ") + name, "")),
        "invalid-field: data file");
  for (const char* name : {"/dev/zero", ".", "missing.raw", "LIST", "part%03d.raw 1 9 1"})
    expectRefusal(
        folder.write("v.mhd", std::string("ObjectType = Image\nNDims = 3\nDimSize = 3 4 2\n"
                                          "ElementType = MET_UCHAR\nElementDataFile = ") +
                                  name + "\n"),
        "");
}

// ---- real data

std::filesystem::path findData(const std::string& name) {
  return std::filesystem::path(FENESTRA_DATA) / name;
}

TEST(VolumeReader, ReadsRealScans) {
  if (!std::filesystem::exists(findData("torso_ct_ccth_a01")))
    GTEST_SKIP() << "no test data at " << FENESTRA_DATA;
  const Volume torso = readVolume(findData("torso_ct_ccth_a01/ct.nii.gz"));
  EXPECT_EQ(torso.grid.size, Size3(493, 389, 296));
  EXPECT_TRUE(std::holds_alternative<LargeArray<std::int16_t>>(torso.voxels));
  EXPECT_EQ(torso.minimum, -1024.0);
  EXPECT_NEAR(torso.grid.spacing().z(), 2.5, 1e-3);
  const Volume abdomen = readVolume(findData("abdomen_ct_totalseg/ct.nii.gz"));
  EXPECT_EQ(abdomen.grid.size, Size3(122, 101, 112));
  EXPECT_TRUE(std::holds_alternative<LargeArray<std::int16_t>>(abdomen.voxels)); // file: int32
  const Volume head = readVolume(findData("head_mr_seg3d/t1.nii.gz"));
  EXPECT_EQ(head.grid.size, Size3(160, 232, 160));
  EXPECT_NEAR(head.maximum, 255 * 2.007843, 1e-3); // uint8 in the file, rescaled
  const Volume chest = readVolume(findData("slicerio_segnrrd/CTChest4.nrrd"));
  EXPECT_EQ(chest.grid.size, Size3(128, 128, 34));
  EXPECT_TRUE(
      isApprox(chest.grid.indexToWorld * Vec3::Zero(), Vec3(-193.096, -216.396, -340.25), 1e-4));
}

} // namespace
} // namespace fenestra::core::VolumeReaderTests
