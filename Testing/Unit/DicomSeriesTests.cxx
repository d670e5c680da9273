// DICOM series written by GDCM, a real series, and invalid files.

#include "files/medical/DicomSeries.h"

#include "Approx.h"
#include "MedicalFiles.h"
#include "files/medical/HounsfieldOffset.h"
#include "files/medical/SuppressItkOutput.h"
#include "files/medical/VolumeReader.h"

#include <gdcmImageChangeTransferSyntax.h>
#include <gdcmImageReader.h>
#include <gdcmImageWriter.h>
#include <itkGDCMImageIO.h>
#include <itkMetaDataObject.h>

#include <random>

namespace fenestra::core::DicomSeriesTests {
namespace {

using Path = std::filesystem::path;

/// Slice as a scanner writes it; LPS.
struct SliceFile {
  unsigned width = 5, height = 4;
  Vec3 position = Vec3::Zero();
  Mat3 axes = Mat3::Identity(); ///< columns: along a row, along a column, normal
  double rowSpacing = 2.0, columnSpacing = 0.5;
  std::string uid = "1.2.3", number = "7", description = "head", modality = "CT";
  std::string intercept = "0", slope = "1";
  std::int16_t first = 0; ///< first of the consecutive stored values
  bool compress = false;  ///< lossless JPEG 2000
  unsigned components = 1;
};

Path write(const Path& path, const SliceFile& slice) {
  const unsigned width = slice.width, height = slice.height;
  const SuppressItkOutput quiet; // GDCM warns about missing files
  const auto io = itk::GDCMImageIO::New();
  io->SetFileName(path.string());
  io->KeepOriginalUIDOn();
  io->SetNumberOfDimensions(3);
  itk::ImageIORegion region(3);
  const unsigned sizes[] = {width, height, 1};
  const double spacings[] = {slice.columnSpacing, slice.rowSpacing, 99.0};
  for (unsigned axis = 0; axis < 3; ++axis) {
    io->SetDimensions(axis, sizes[axis]);
    region.SetSize(axis, sizes[axis]);
    io->SetSpacing(axis, spacings[axis]);
    io->SetOrigin(axis, slice.position[axis]);
    const Vec3 direction = slice.axes.col(axis);
    io->SetDirection(axis, std::vector<double>(direction.begin(), direction.end()));
  }
  io->SetIORegion(region);
  io->SetNumberOfComponents(slice.components);
  const auto set = [&](const char* tag, const std::string& text) {
    itk::EncapsulateMetaData<std::string>(io->GetMetaDataDictionary(), tag, text);
  };
  set("0008|0060", slice.modality);
  set("0008|103e", slice.description);
  set("0020|000e", slice.uid);
  set("0020|0011", slice.number);
  set("0028|1052", slice.intercept);
  set("0028|1053", slice.slope);
  set("0028|0100", "16"); // storage type for floats
  set("0028|0101", "16");
  set("0028|0102", "15");
  set("0028|0103", "1");
  io->SetUseCompression(slice.compress);
  if (slice.components == 3) {
    io->SetPixelType(itk::IOPixelEnum::RGB);
    io->SetComponentType(itk::IOComponentEnum::UCHAR);
    io->Write(std::vector<std::uint8_t>(3 * width * height).data());
    return path;
  }
  io->SetPixelType(itk::IOPixelEnum::SCALAR);
  // GDCM rescales the written values, in float if they have fractions.
  const double intercept = std::stod(slice.intercept), slope = std::stod(slice.slope);
  std::vector<std::int16_t> integers(width * height);
  std::vector<float> fractions(width * height);
  for (unsigned i = 0; i < width * height; ++i) {
    fractions[i] = static_cast<float>(slope * (slice.first + static_cast<int>(i)) + intercept);
    integers[i] = static_cast<std::int16_t>(fractions[i]);
  }
  const bool isInteger = slope == std::trunc(slope);
  io->SetComponentType(isInteger ? itk::IOComponentEnum::SHORT : itk::IOComponentEnum::FLOAT);
  io->Write(isInteger ? static_cast<const void*>(integers.data()) : fractions.data());
  return path;
}

/// Writes `count` slices along the normal; the order of the file names is not that of the slices.
void writeStack(const TemporaryFolder& folder, SliceFile slice, int count, double step) {
  const Vec3 begin = slice.position;
  for (int i = 0; i < count; ++i) {
    slice.position = begin + step * i * slice.axes.col(2);
    slice.first = static_cast<std::int16_t>(100 * i);
    write(folder / ("file" + std::to_string(i * 7 % count) + "_" + slice.number + ".dcm"), slice);
  }
}

Volume readSingleSeries(const Path& folder) {
  return readDicomVolume(
      chooseSeries(findDicomSeries(folder).series, std::nullopt, folder.string()));
}

double getVoxel(const Volume& volume, std::int64_t x, std::int64_t y, std::int64_t z) {
  const auto i =
      static_cast<std::size_t>(x + volume.grid.size.x() * (y + volume.grid.size.y() * z));
  return std::visit([i](const auto& voxels) { return static_cast<double>(voxels[i]); },
                    volume.voxels);
}

Mat3 makeObliqueAxes() {
  return (makeRotation(0.4, Vec3(1, 2, 3).normalized()) * makeRotation(0.3, Vec3::UnitX()))
      .linear();
}

TEST(SuppressItkOutput, OutputReturnsWithTheLastObject) {
  std::streambuf* const before = std::cerr.rdbuf();
  auto first = std::make_unique<SuppressItkOutput>(),
       second = std::make_unique<SuppressItkOutput>();
  first.reset(); // as in two threads
  EXPECT_EQ(std::cerr.rdbuf(), nullptr);
  second.reset();
  EXPECT_EQ(std::cerr.rdbuf(), before);
}

TEST(DicomSeries, SortsSlicesAlongTheirNormal) {
  const TemporaryFolder folder;
  SliceFile slice{.position = {10, -20, 30}, .axes = makeObliqueAxes()};
  writeStack(folder, slice, 5, 2.5);
  folder.write("notes.txt", "not DICOM");
  const Volume volume = readSingleSeries(folder.path());
  EXPECT_EQ(volume.grid.size, Size3(5, 4, 5));
  EXPECT_TRUE(volume.warnings.empty()) << volume.warnings[0].text();
  for (int z = 0; z < 5; ++z)
    for (int y = 0; y < 4; ++y)
      for (int x = 0; x < 5; ++x) {
        EXPECT_EQ(getVoxel(volume, x, y, z), 100 * z + y * 5 + x);
        const Vec3 lps = slice.position + slice.axes * Vec3(0.5 * x, 2.0 * y, 2.5 * z);
        EXPECT_LT(
            (volume.grid.indexToWorld * Vec3(x, y, z) - Vec3(-lps[0], -lps[1], lps[2])).norm(),
            1e-4); // numbers are rounded in the files
      }
}

TEST(DicomSeries, AppliesRescaleAndKeepsGantryTilt) {
  const TemporaryFolder folder;
  for (int i = 0; i < 3; ++i)
    write(folder / (std::to_string(i) + ".dcm"),
          {.position = Vec3(0, 0.7 * i, 3.0 * i), .intercept = "-1024", .slope = "2"});
  const Volume volume = readSingleSeries(folder.path());
  EXPECT_EQ(volume.minimum, -1024);
  EXPECT_EQ(volume.maximum, -1024 + 2 * 19);
  EXPECT_TRUE(isApprox(volume.grid.indexToWorld.linear().col(2), Vec3(0, -0.7, 3.0)));
}

TEST(DicomSeries, SlicesCanDifferInSlope) {
  const TemporaryFolder folder;
  int i = 0;
  for (const char* slope : {"1", "0.5", "0.25"}) {
    write(folder / (std::to_string(i) + ".dcm"), {.position = Vec3(0, 0, i), .slope = slope});
    ++i;
  }
  const Volume volume = readSingleSeries(folder.path());
  EXPECT_EQ(getVoxel(volume, 4, 3, 0), 19.0);
  EXPECT_EQ(getVoxel(volume, 4, 3, 1), 9.5);
  EXPECT_EQ(getVoxel(volume, 4, 3, 2), 4.75);
}

TEST(DicomSeries, DecodesJpeg2000AndRejectsDamagedStreams) {
  const TemporaryFolder folder;
  SliceFile slice{.width = 60, .height = 50, .intercept = "-1024", .first = -3, .compress = true};
  const Path file = write(folder / "one.dcm", slice);
  const std::string bytes = readBytes(file);
  ASSERT_NE(bytes.find("\xff\x4f\xff\x51"), std::string::npos); // start of a codestream
  const Volume volume = readDicomVolume({file}, "x");
  for (int i = 0; i < 3000; ++i)
    ASSERT_EQ(getVoxel(volume, i % 60, i / 60, 0), i - 3 - 1024);
  std::string wider = bytes; // width in the codestream, larger than declared
  wider[wider.find("\xff\x4f\xff\x51") + 8] = 1;
  folder.write("wider.dcm", wider);
  const Path truncated = folder.write("half.dcm", bytes.substr(0, bytes.size() - 40));
  fenestra::core::expectRefused(truncated, "damaged-file: PixelData",
                                [&] { readDicomVolume({truncated}, "x"); });
  fenestra::core::expectRefused(folder / "wider.dcm", "damaged-file: PixelData",
                                [&] { readDicomVolume({folder / "wider.dcm"}, "x"); });
}

TEST(DicomSeries, EveryTransferSyntaxGivesTheSameVoxels) {
  const TemporaryFolder folder;
  const Path file = write(folder / "one.dcm", {.width = 60, .height = 50, .first = -3});
  using Syntax = gdcm::TransferSyntax;
  for (const auto syntax :
       {Syntax::ImplicitVRLittleEndian, Syntax::ExplicitVRLittleEndian, Syntax::ExplicitVRBigEndian,
        Syntax::RLELossless, Syntax::JPEGLosslessProcess14_1, Syntax::JPEGLSLossless}) {
    gdcm::ImageReader reader;
    reader.SetFileName(file.c_str());
    ASSERT_TRUE(reader.Read());
    gdcm::ImageChangeTransferSyntax change;
    change.SetTransferSyntax(syntax);
    change.SetInput(reader.GetImage());
    ASSERT_TRUE(change.Change()) << syntax;
    gdcm::ImageWriter writer;
    writer.SetFile(reader.GetFile());
    writer.SetImage(change.GetOutput());
    writer.SetFileName((folder / "stored.dcm").c_str());
    ASSERT_TRUE(writer.Write());
    const Volume volume = readDicomVolume({folder / "stored.dcm"}, "x");
    for (int i = 0; i < 3000; ++i)
      ASSERT_EQ(getVoxel(volume, i % 60, i / 60, 0), i - 3) << syntax;
  }
}

TEST(DicomSeries, ReadsASingleSlice) {
  const TemporaryFolder folder;
  const Path file = write(folder / "one.dcm", {.position = {1, 2, 3}});
  const Volume volume = readDicomVolume({file}, "scene");
  EXPECT_EQ(volume.grid.size, Size3(5, 4, 1));
  EXPECT_TRUE(isApprox(volume.grid.indexToWorld.translation(), Vec3(-1, -2, 3)));
  EXPECT_EQ(volume.name, "scene");
}

TEST(DicomSeries, SelectorChoosesAmongSeries) {
  const TemporaryFolder folder;
  writeStack(folder, {}, 2, 1);
  writeStack(folder, {.uid = "1.2.4", .number = "12", .description = "neck"}, 3, 1);
  writeStack(folder, {.uid = "1.2.5", .number = "8", .description = "neck"}, 4, 1);
  writeStack(folder, {.uid = "1.2.6", .number = "9", .modality = "SEG"}, 1, 1); // no volume
  const auto series = findDicomSeries(folder.path()).series;
  ASSERT_EQ(series.size(), 3u);
  EXPECT_EQ(series[0].number, "7");
  EXPECT_EQ(series[1].number, "8");
  EXPECT_EQ(series[2].number, "12");
  EXPECT_EQ(series[2].modality, "CT");
  const auto choose = [&](const std::optional<std::string>& selector) {
    return chooseSeries(series, selector, folder.path().string());
  };
  EXPECT_EQ(choose("1.2.4").files().size(), 3u);
  EXPECT_EQ(choose("8").files().size(), 4u);
  EXPECT_EQ(choose("head").files().size(), 2u);
  fenestra::core::expectRefused(
      folder.path(), "ambiguous-volume | 3 DICOM | number 7 \"head\" CT 1.2.3 (2 slices); number 8",
      [&] { choose(std::nullopt); });
  fenestra::core::expectRefused(folder.path(), "ambiguous-name | \"neck\" | number 8",
                                [&] { choose("neck"); });
  fenestra::core::expectRefused(folder.path(), "unknown-name | \"foot\" | number 8",
                                [&] { choose("foot"); });
}

TEST(DicomSeries, SearchesSubfolders) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "a");
  std::filesystem::create_directories(folder / "b");
  write(folder / "a/1.dcm", {});
  write(folder / "b/2.dcm", {.position = {0, 0, 4}});
  EXPECT_EQ(readSingleSeries(folder.path()).grid.size.z(), 2);
  folder.write("readme", "");
  EXPECT_EQ(readSingleSeries(folder.path()).grid.size.z(), 2);
}

void expectRefused(const Path& subject, const Path& folder, const std::string& expected) {
  fenestra::core::expectRefused(subject, expected, [&] { readSingleSeries(folder); });
}

/// Writes slices at these depths, in files 0.dcm, 1.dcm, ...
void writeDepths(const TemporaryFolder& folder, const std::vector<double>& depths) {
  for (std::size_t i = 0; i < depths.size(); ++i)
    write(folder / (std::to_string(i) + ".dcm"), {.position = {0, 0, depths[i]}});
}

TEST(DicomSeries, RejectsSlicesBesideTheOthers) {
  const TemporaryFolder folder;
  for (int i = 0; i < 3; ++i)
    write(folder / (std::to_string(i) + ".dcm"), {.position = Vec3(i == 1 ? 0.6 : 0, 0, i)});
  expectRefused(folder / "1.dcm", folder.path(), "invalid-field: ImagePositionPatient");
}

TEST(DicomSeries, WarnsOfUnevenSpacing) {
  const TemporaryFolder folder, even;
  writeDepths(folder, {0, 2.1, 4, 6});
  const Volume volume = readSingleSeries(folder.path());
  ASSERT_EQ(volume.warnings.size(), 1u);
  EXPECT_EQ(volume.warnings[0].subject, folder.path());
  expectMessage(volume.warnings[0], "assumed-geometry | 0.1 mm | 2 mm");
  EXPECT_NEAR(volume.grid.spacing().z(), 2.0, 1e-12);
  writeDepths(even, {0, 2.01, 4, 6});
  EXPECT_TRUE(readSingleSeries(even.path()).warnings.empty());
}

/// Overwrites the start of an element's value in a file's bytes. The element has no explicit VR.
void overwriteElement(std::string& bytes, const std::string& tag, const std::string& value) {
  const std::size_t at = bytes.find(tag);
  ASSERT_NE(at, std::string::npos);
  bytes.replace(at + tag.size() + 4, value.size(), value);
}

TEST(DicomSeries, RejectsFilesThatAreNotGraySlices) {
  const TemporaryFolder folder;
  const Path colored = write(folder / "rgb.dcm", {.components = 3});
  const auto read = [](const Path& file) { return [file] { readDicomVolume({file}, "x"); }; };
  fenestra::core::expectRefused(colored, "invalid-field: PhotometricInterpretation", read(colored));
  const std::string bytes = readBytes(write(folder / "a.dcm", {}));
  const auto expect = [&](const std::string& tag, const std::string& value, const char* text) {
    std::string changed = bytes;
    overwriteElement(changed, tag, value);
    const Path file = folder.write("changed.dcm", changed);
    fenestra::core::expectRefused(file, text, read(file));
  };
  using namespace std::string_literals;
  expect("\x28\0\x10\0"s, "\xff\xff", "invalid-field: PixelData");
  expect("\x28\0\x10\0"s, "\0\0"s, "invalid-field: Rows or Columns");
  expect("\x28\0\x30\0"s, "0\\0", "invalid-field: PixelSpacing");
  expect("\x28\0\x30\0"s, "-1\\1", "invalid-field: PixelSpacing");
  expect("\x28\0\x53\x10"s, "nan", "invalid-field: RescaleSlope or RescaleIntercept");
  expect("\x28\0\x52\x10"s, "x", "invalid-field: RescaleSlope or RescaleIntercept");
  expect("\x20\0\x32\0"s, "x", "invalid-field: ImagePositionPatient or ImageOrientationPatient");
  expect("\x20\0\x37\0"s, "1\\1", "invalid-field: ImageOrientationPatient");
  const Path truncated = folder.write("half.dcm", bytes.substr(0, bytes.size() - 10));
  fenestra::core::expectRefused(truncated, "damaged-file", read(truncated));
  const Path none = folder.write("none.dcm", "what");
  fenestra::core::expectRefused(none, "unsupported-file", read(none));
  fenestra::core::expectRefused(folder / "absent", "unreadable-file",
                                [&] { findDicomSeries(folder / "absent"); });
}

/// Damaged bytes must be read, or rejected with a message of one line.
TEST(DicomSeries, DamagedBytesAreReadOrRejected) {
  const TemporaryFolder folder;
  const std::string original = readBytes(write(folder / "a.dcm", {}));
  std::mt19937 random(11);
  int readCount = 0;
  ::testing::internal::CaptureStderr();
  for (int i = 0; i < 100; ++i) {
    std::string bytes = original;
    if (i % 8 == 0)
      bytes.resize(133 + random() % (original.size() - 133));
    for (int n = 0; n <= i % 4; ++n)
      bytes[132 + random() % (bytes.size() - 132)] = static_cast<char>(random());
    const Path file = folder.write(std::to_string(i) + ".dcm", bytes);
    try {
      readDicomVolume({file}, "x");
      ++readCount;
    } catch (const Error& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    }
  }
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  EXPECT_GT(readCount, 3);
}

/// Ball of soft tissue in air.
Volume makeBall(double tissue, double air) {
  LargeArray<std::int16_t> voxels;
  for (int z = 0; z < 8; ++z)
    for (int y = 0; y < 16; ++y)
      for (int x = 0; x < 16; ++x)
        voxels.push_back(
            static_cast<std::int16_t>(Vec3(x - 7.5, y - 7.5, z - 3.5).norm() < 3.5 ? tissue : air));
  Volume volume;
  volume.grid = {Size3(16, 16, 8), Affine::Identity()};
  volume.voxels = std::move(voxels);
  volume.name = "ball";
  computeRange(volume);
  return volume;
}

TEST(HounsfieldOffset, OnlyAnUnambiguousCtIsCorrected) {
  struct {
    double tissue, air;
    bool moves, warns;
  } const cases[] = {{1060.0, 0.0, true, true},      {1060.0, 24.0, true, true},
                     {1060.0, 100.0, false, false},  {700.0, 0.0, false, true},
                     {1500.0, 0.0, false, true},     {40.0, -1000.0, false, false},
                     {1060.0, -300.0, false, false}, {100.0, 0.0, false, false}};
  for (const auto& testCase : cases) {
    Volume volume = makeBall(testCase.tissue, testCase.air);
    correctHounsfieldOffset(volume);
    EXPECT_EQ(getVoxel(volume, 8, 8, 4), testCase.tissue - (testCase.moves ? 1024.0 : 0.0))
        << testCase.tissue;
    EXPECT_EQ(volume.minimum, testCase.air - (testCase.moves ? 1024.0 : 0.0)) << testCase.tissue;
    EXPECT_EQ(!volume.warnings.empty(), testCase.warns) << testCase.tissue << ' ' << testCase.air;
  }
}

/// A head as a DICOM series (rescale intercept 0, although its air is at 0) and as the volume in HU
/// that another program converted it to.
TEST(DicomSeries, RealSeriesEqualsItsNiftiFile) {
  const Path folder = Path(FENESTRA_DATA) / "head_ct_slicer_dicom";
  if (!std::filesystem::exists(folder))
    GTEST_SKIP() << "no real data at " << FENESTRA_DATA;
  const Volume series = readSingleSeries(folder / "dicom");
  const Volume expected = readVolume(folder / "ct_hu.nii.gz");
  ASSERT_EQ(series.grid.voxelCount(), expected.grid.voxelCount());
  const Affine toExpected = expected.grid.worldToIndex * series.grid.indexToWorld;
  for (std::int64_t z = 0; z < series.grid.size.z(); ++z)
    for (std::int64_t y = 0; y < series.grid.size.y(); ++y)
      for (std::int64_t x = 0; x < series.grid.size.x(); ++x) {
        const Vec3 position = toExpected * Size3(x, y, z).cast<double>();
        const Vec3 voxel = position.array().round();
        ASSERT_LT((position - voxel).norm(), 1e-3);
        const Size3 i = voxel.cast<std::int64_t>();
        ASSERT_TRUE((i.array() >= 0).all() && (i.array() < expected.grid.size.array()).all());
        ASSERT_EQ(getVoxel(series, x, y, z), getVoxel(expected, i.x(), i.y(), i.z()));
      }
}

/// Codestream that once crashed the decoder of GDCM. Whether it is read or rejected depends on the
/// memory layout.
TEST(DicomSeries, StreamThatCrashesTheDecoderIsReadOrRejected) {
  const auto damaged = Path(__FILE__).parent_path() / "../Fuzz/Sandbox/Dicom/jpeg2000-stream.dcm";
  ASSERT_TRUE(std::filesystem::exists(damaged));
  try {
    EXPECT_EQ(readDicomVolume({damaged}, "CT").grid.size, Size3(32, 32, 1));
  } catch (const Error& error) {
    expectMessage(error.message(), "damaged-file: PixelData");
  }
}

} // namespace
} // namespace fenestra::core::DicomSeriesTests
