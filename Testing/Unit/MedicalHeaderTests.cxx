// Volume headers with valid but unsupported content: errors that state the cause, and warnings.

#include "files/medical/VolumeReader.h"

#include "MedicalFiles.h"

#include <gtest/gtest.h>
#include <zlib.h>

namespace fenestra::core::MedicalHeaderTests {
namespace {

using Path = std::filesystem::path;

class MedicalHeaders : public ::testing::Test {
protected:
  static void refuse(const Path& path, const std::string& text) {
    expectRefused(path, text, [&path] { readVolume(path); });
  }
  /// Writes a file of 3x4x2 samples; each of the header `lines` ends with a line break.
  Path writeNrrd(const std::string& lines, const std::string& encoding = "raw",
                 const std::string& data = std::string(24, 'x')) const {
    return folder.write("v.nrrd", "NRRD0004\ntype: unsigned char\ndimension: 3\nsizes: 3 4 2\n"
                                  "encoding: " +
                                      encoding + "\n" + lines + "\n" + data);
  }
  Path writeMeta(const std::string& lines) const {
    return folder.write("v.mha", "ObjectType = Image\nNDims = 3\nElementType = MET_UCHAR\n" +
                                     lines + "ElementDataFile = LOCAL\n" + std::string(24, 'x'));
  }

  TemporaryFolder folder;
};

const std::string space = "space: left-posterior-superior\n";
const std::string unitDirections = "space directions: (1,0,0) (0,1,0) (0,0,1)\n";

TEST_F(MedicalHeaders, BadGeometryIsRefused) {
  for (const char* vector :
       {"(0,0,1e200)", "(0,0,2e9)", "(0,0,1e-10)", "(0,0,1e999)", "(0,0,inf)", "(0,0,x)", "(0,0,1"})
    refuse(writeNrrd(space + "space directions: (1,0,0) (0,1,0) " + vector + "\n"),
           "invalid-field: space directions");
  refuse(writeNrrd(space + "space directions: (1,0,0) (0,1,0) none\n"),
         "invalid-field: space directions");
  refuse(writeNrrd("axis mins: 10 0 0\naxis maxs: 17 7 21\n"), "invalid-field: axis mins");
  refuse(writeNrrd("axismaxs: 17 7 21\n"), "invalid-field: axis maxs");
  EXPECT_EQ(readVolume(writeNrrd("spacings: 1 2 3\naxis mins: 10 0 0\n")).grid.spacing(),
            Vec3(1, 2, 3));
  refuse(writeNrrd("spacings: 1 1 1e10\n"), "invalid-field: spacing");
  refuse(writeNrrd(space + "spacings: 1 1 3\n"), "invalid-field: spacings");
}

TEST_F(MedicalHeaders, MissingSpacingWarnsAndDefaultsToOneMillimeter) {
  for (const std::string& lines : {std::string(), space + "space directions: none none none\n"}) {
    const Volume volume = readVolume(writeNrrd(lines));
    ASSERT_EQ(volume.warnings.size(), 1u) << lines;
    expectMessage(volume.warnings[0], "assumed-geometry | 1 mm");
    EXPECT_EQ(volume.grid.spacing(), Vec3(1, 1, 1));
  }
  EXPECT_TRUE(readVolume(writeNrrd(space + unitDirections)).warnings.empty());
  EXPECT_EQ(readVolume(writeNrrd("spacings: 1 1 1\n")).warnings.size(), 1u) << "no space";
  const std::string size = "DimSize = 3 4 2\n";
  EXPECT_EQ(readVolume(writeMeta(size)).warnings.size(), 1u);
  EXPECT_TRUE(readVolume(writeMeta(size + "ElementSpacing = 1 1 1\n")).warnings.empty());
}

TEST_F(MedicalHeaders, UnitsOtherThanMillimetersAreRefused) {
  const std::string placed = space + unitDirections;
  for (const char* unit : {"m", "cm", "Inch", "um"})
    refuse(writeNrrd(placed + "space units: \"" + unit + "\" \"mm\" \"mm\"\n"),
           "invalid-field: space units | " + std::string(unit));
  refuse(writeNrrd("spacings: 1 1 1\nunits: \"cm\" \"cm\" \"cm\"\n"), "invalid-field: units");
  for (const char* units : {R"("mm" "mm" "mm")", R"("" "" "")", R"("MM" "millimeters" "?")"})
    EXPECT_EQ(readVolume(writeNrrd(placed + "space units: " + units + "\n")).maximum, 'x') << units;
  refuse(writeMeta("DimSize = 3 4 2\nDistanceUnits = m\n"), "invalid-field: DistanceUnits");
  EXPECT_EQ(readVolume(writeMeta("DimSize = 3 4 2\nDistanceUnits = mm\n")).maximum, 'x');
}

TEST_F(MedicalHeaders, UnsupportedRescalingIsRefused) {
  const std::string size = "DimSize = 3 4 2\n";
  refuse(writeMeta(size + "ElementToIntensityFunctionSlope = 2\n"),
         "invalid-field: ElementToIntensityFunctionSlope");
  refuse(writeMeta(size + "ElementToIntensityFunctionOffset = -1024\n"),
         "invalid-field: ElementToIntensityFunctionOffset");
  EXPECT_EQ(readVolume(writeMeta(size + "ElementToIntensityFunctionSlope = 1.0\n"
                                        "ElementToIntensityFunctionOffset = 0\n"))
                .maximum,
            'x');
  writeFile(folder / "v.nii", std::vector<std::uint8_t>(24, 'x'));
  for (const std::size_t at : {112u, 116u}) { // slope, intercept
    std::string bytes = readBytes(folder / "v.nii");
    bytes.replace(112, 4, rawBytes(std::vector<float>{2.0f}));
    bytes.replace(at, 4, rawBytes(std::vector<float>{std::numeric_limits<float>::infinity()}));
    refuse(folder.write("inf.nii", bytes), "invalid-field: scl_slope or scl_inter");
  }
}

TEST_F(MedicalHeaders, ByteSkipInCompressedDataIsLimited) {
  const std::string samples = "abc" + std::string(24, 'x');
  std::string stream(200, '\0');
  z_stream z{};
  ASSERT_EQ(deflateInit2(&z, 9, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY), Z_OK); // + 16: gzip
  z.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(samples.data()));
  z.avail_in = static_cast<uInt>(samples.size());
  z.next_out = reinterpret_cast<Bytef*>(stream.data());
  z.avail_out = static_cast<uInt>(stream.size());
  ASSERT_EQ(deflate(&z, Z_FINISH), Z_STREAM_END);
  stream.resize(z.total_out);
  deflateEnd(&z);
  EXPECT_EQ(readVolume(writeNrrd("byte skip: 3\n", "gzip", stream)).minimum, 'x');
  for (const char* bytes : {"1073741824", "1048577", "99999999999999999999", "-1"})
    refuse(writeNrrd(std::string("byte skip: ") + bytes + "\n", "gzip", stream),
           "invalid-field: byte skip");
}

TEST_F(MedicalHeaders, ErrorNamesFieldAndCause) {
  for (const char* encoding : {"bzip2", "bz2", "zrl"})
    refuse(writeNrrd("spacings: 1 1 1\n", encoding),
           "invalid-field: encoding | " + std::string(encoding));
  const std::string head = "NRRD0004\ntype: unsigned char\nencoding: raw\n";
  refuse(folder.write("two.nrrd", head + "dimension: 2\nsizes: 3 4\n" + space +
                                      "space directions: (1,0,0) (0,1,0)\n\n" +
                                      std::string(12, 'x')),
         "unsupported-file");
  const std::string series = head + "dimension: 4\nsizes: 3 4 2 1\n" + space +
                             "space directions: (1,0,0) (0,1,0) (0,0,1) none\n";
  refuse(folder.write("five.nrrd", head + "dimension: 5\nsizes: 3 4 2 1 1\n" + space +
                                       "space directions: (1,0,0) (0,1,0) (0,0,1) none none\n\n" +
                                       std::string(24, 'x')),
         "invalid-field: kinds");
  EXPECT_EQ(readVolume(folder.write("one.nrrd", series + "kinds: domain domain domain list\n\n" +
                                                    std::string(24, 'x')))
                .grid.size,
            Size3(3, 4, 2));
  folder.write("half.raw", std::string(12, 'x'));
  refuse(folder.write("v.nhdr", head + "dimension: 3\nsizes: 3 4 2\nspacings: 1 1 1\n"
                                       "data file: LIST\nhalf.raw\nhalf.raw\n\n"),
         "invalid-field: data file | LIST");
  refuse(writeNrrd(space + unitDirections + "units: \"mm\" \"mm\" \"mm\"\n"),
         "invalid-field: units");
  refuse(writeMeta("DimSize = -3 4 2\n"), "invalid-field: DimSize");
  refuse(writeMeta("DimSize = 3 4.5 2\n"), "invalid-field: DimSize");
}

} // namespace
} // namespace fenestra::core::MedicalHeaderTests
