// Layouts of DICOM files as scanners, archives and anonymizers leave them: folders, several volumes
// in one series, and incomplete series.

#include "Approx.h"
#include "DicomSliceFiles.h"

#include <array>

namespace fenestra::core::DicomLayoutTests {
namespace {

using namespace dicomSlices;

// ---- folders

TEST(DicomLayout, FindsASeriesDeepInATreeWithOtherFiles) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "DICOM/S1/SE1");
  std::filesystem::create_directories(folder / "VIEWER");
  folder.write("AUTORUN.INF", "[autorun]");
  folder.write("VIEWER/run.exe", "MZ");
  folder.write("DICOM/S1/SE1/IM1", makeSlice({.value = 1}));
  folder.write("DICOM/S1/SE1/IM0", makeSlice({.value = 2, .position = {0, 0, 3}}));
  std::filesystem::create_directory_symlink(folder.path(), folder / "DICOM/loop");
  EXPECT_EQ(getScalars(read(folder.path())), (std::vector{1.0, 2.0}));
}

TEST(DicomLayout, SlicesWithoutASeriesUidAreGroupedByWhatTheyShare) {
  const TemporaryFolder folder;
  for (int i = 0; i < 6; ++i)
    folder.write(std::to_string(i),
                 makeSlice({.value = 1.0 * i,
                            .position = Vec3(0, 0, 3 * (i % 3)),
                            .seriesUid = "",
                            .more = {makeText(0x0008103e, "LO", i < 3 ? "thin" : "thick")}}));
  const DicomFolder found = findDicomSeries(folder.path());
  ASSERT_EQ(found.series.size(), 2u);
  EXPECT_EQ(found.series[0].files().size(), 3u);
  EXPECT_EQ(getScalars(read(folder.path(), {.name = "thick"})), (std::vector{3.0, 4.0, 5.0}));
}

TEST(DicomLayout, AFileStandsForItsSeries) {
  const TemporaryFolder folder;
  writeDepths(folder, {0, 2, 4});
  folder.write("other", makeSlice({.seriesUid = "1.2.9"}));
  const DicomFolder found = findSeriesOfFile(folder / "1");
  ASSERT_EQ(found.series.size(), 1u);
  const Volume volume = readDicomVolume(found.series[0]);
  EXPECT_EQ(volume.grid.size.z(), 3);
  ASSERT_EQ(volume.warnings.size(), 1u);
  expectMessage(volume.warnings[0], "assumed-geometry | 3");
}

/// A file that ends within the first item of a sequence, on which GDCM terminates its process.
std::string makeFatalFile() {
  using namespace std::string_literals;
  return std::string(128, '\0') + "DICM\2\0\x10\0UI\x14\0"s + "1.2.840.10008.1.2.1\0"s +
         "\4\0\x20\x12SQ\0\0\xc8\x29\0\0\xfe\xff\0\xe0"s;
}

TEST(DicomLayout, UnreadableFilesAreLeftOut) {
  const TemporaryFolder folder;
  writeDepths(folder, {0, 2, 4});
  folder.write("directory", makeFatalFile());
  const DicomFolder found = findDicomSeries(folder.path());
  ASSERT_EQ(found.series.size(), 1u);
  const Volume volume = readDicomVolume(found.series[0]);
  EXPECT_EQ(volume.grid.size.z(), 3);
  ASSERT_EQ(volume.warnings.size(), 1u);
  expectMessage(volume.warnings[0], "omitted-slices: directory");
}

TEST(DicomLayout, ManyUnreadableFilesAreRefused) {
  const TemporaryFolder folder;
  for (int i = 0; i < 20; ++i)
    folder.write(std::to_string(i), makeFatalFile());
  EXPECT_THROW(findDicomSeries(folder.path()), Error);
}

TEST(DicomLayout, SegmentationsAreNoSeries) {
  const TemporaryFolder folder;
  writeDepths(folder, {0, 2, 4});
  folder.write("seg", makeSegFile({.frames = {{}}}));
  folder.write("rt", makeStructureFile({{}}));
  const DicomFolder found = findDicomSeries(folder.path());
  EXPECT_EQ(found.series.size(), 1u);
  EXPECT_EQ(found.segmentations.size(), 2u);
  fenestra::core::expectRefused(folder / "seg", "segmentation-as-volume",
                                [&] { findSeriesOfFile(folder / "seg"); });
}

TEST(DicomLayout, SegmentationsReferToASeriesOrItsFrame) {
  const TemporaryFolder folder;
  const auto makeFrame = [](const char* uid) { return makeText(0x00200052, "UI", uid); };
  folder.write("ct", makeSlice({.more = {makeFrame("1.5")}}));
  const auto write = [&](const char* name, const Element& reference) {
    folder.write(name, makeFile(merge({makeText(0x00080016, "UI", "1.2.840.10008.5.1.4.1.1.66.4"),
                                       makeText(0x00080060, "CS", "SEG"),
                                       makeText(0x0020000e, "UI", "1.2.8")},
                                      {reference}),
                                Syntax::explicitLittle));
  };
  const auto makeReference = [](const char* uid) {
    return makeSequence(0x00081115, {{makeText(0x0020000e, "UI", uid)}});
  };
  write("series", makeReference("1.2.3"));
  write("other series", makeReference("1.2.4"));
  write("frame", makeFrame("1.5"));
  write("other frame", makeFrame("1.6"));
  const DicomFolder found = findDicomSeries(folder.path());
  EXPECT_EQ(found.segmentationsOf(found.series.at(0)),
            (std::vector{folder / "frame", folder / "series"}));
}

TEST(DicomLayout, UnsupportedTransferSyntaxesAreNamed) {
  const TemporaryFolder folder;
  folder.write("a", makeSlice({}, Syntax::htj2k));
  for (const auto& read : std::vector<std::function<void()>>{
           [&] { findDicomSeries(folder.path()); }, [&] { findSeriesOfFile(folder / "a"); },
           [&] { readDicomVolume({folder / "a"}, "x"); }})
    fenestra::core::expectRefused(folder / "a",
                                  "unsupported-file | HTJ2K | 1.2.840.10008.1.2.4.201", read);
  folder.write("b", makeSlice({}, Syntax::htj2k));
  folder.write("c", makeSlice({.value = 3}));
  const Volume volume = read(folder.path());
  EXPECT_EQ(getScalars(volume), std::vector{3.0});
  ASSERT_EQ(volume.warnings.size(), 1u);
  expectMessage(volume.warnings[0], "omitted-slices: a | HTJ2K | 2");
}

TEST(DicomLayout, ObjectsWithoutAScanAreNamed) {
  const TemporaryFolder folder;
  folder.write("a", makeSlice({.more = {makeText(0x00080060, "CS", "RTDOSE")}}));
  fenestra::core::expectRefused(folder / "a", "unsupported-file | RT Dose",
                                [&] { findSeriesOfFile(folder / "a"); });
}

TEST(DicomLayout, ADirectoryFileStandsForItsFolder) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "IMAGES");
  folder.write("IMAGES/a", makeSlice({.value = 3}));
  const std::string directory = dicom::makeFile(
      {makeText(0x00041130, "CS", "DISC")}, Syntax::explicitLittle, true, "1.2.840.10008.1.3.10");
  folder.write("DICOMDIR", directory);
  EXPECT_EQ(findSeriesOfFile(folder / "DICOMDIR").series.size(), 1u);
}

TEST(DicomLayout, FilesMayLackPreambleAndMetaInformation) {
  const TemporaryFolder folder;
  constexpr std::size_t preamble = 132;
  const std::vector<Element> more = {makeText(0x00080008, "CS", "ORIGINAL\\PRIMARY\\AXIAL")};
  for (const Syntax syntax : {Syntax::explicitLittle, Syntax::implicitLittle}) {
    const std::string bytes = makeSlice({.value = 3, .more = more}, syntax);
    const std::string first = syntax == Syntax::implicitLittle
                                  ? std::string("\x08\0\x08\0\x16\0\0\0", 8)
                                  : std::string("\x08\0\x08\0CS", 6);
    for (const std::size_t begin : {preamble, bytes.find(first)}) {
      const Path file = folder.write("a", bytes.substr(begin));
      EXPECT_TRUE(isDicomFile(file));
      EXPECT_EQ(getScalars(read(folder.path())), std::vector{3.0});
    }
  }
}

TEST(DicomLayout, OtherFilesAreNoDicom) {
  const TemporaryFolder folder;
  using namespace std::string_literals;
  for (const std::string& bytes :
       {""s, "\x08\0"s, "\x08\0\x08\0\xff\xff\0\0"s, std::string(2000, '\0'),
        std::string(2000, '\x08'),
        "\x08\0\x08\0\x02\0\0\0AB\x09\0\x16\0\x02\0\0\0CD"s, // another group
        "\x08\0\x08\0\x02\0\0\0AB\x08\0\x05\0\x02\0\0\0CD"s, // not in order
        "\x08\0\x08\0\x02\0\0\0AB"s + std::string(500, '\0')})
    EXPECT_FALSE(isDicomFile(folder.write("a", bytes))) << bytes.size();
}

TEST(DicomLayout, TheOnlyStackIsChosenAmongSingleImages) {
  const TemporaryFolder folder;
  writeDepths(folder, {0, 2, 4});
  folder.write("scout", makeSlice({.seriesUid = "1.2.9"}));
  const Volume volume = read(folder.path());
  EXPECT_EQ(volume.grid.size.z(), 3);
  EXPECT_EQ(countWarnings(volume, ErrorCode::omittedSlices), 1u);
}

// ---- slices that do not belong to the volume

TEST(DicomLayout, LocalizersAndOtherSizesAreLeftOut) {
  const TemporaryFolder folder;
  writeDepths(folder, {0, 2, 4});
  folder.write("wide", makeSlice({.position = {0, 0, 6}, .columns = 8}));
  folder.write("turned", makeSlice({.position = {0, 0, 6},
                                    .axes = Mat3(Vec3(0, 1, 0), Vec3(0, 0, -1), Vec3(-1, 0, 0))}));
  folder.write("scout",
               makeSlice({.position = {0, 0, 6},
                          .more = {makeText(0x00080008, "CS", "ORIGINAL\\PRIMARY\\LOCALIZER")}}));
  const Volume volume = read(folder.path());
  EXPECT_EQ(getScalars(volume), (std::vector{0.0, 1.0, 2.0}));
  ASSERT_EQ(countWarnings(volume, ErrorCode::omittedSlices), 2u);
  expectMessage(volume.warnings[0], "omitted-slices | 1 of 6");
  expectMessage(volume.warnings[1], "omitted-slices | 2 of 6");
}

TEST(DicomLayout, CopiesAreLeftOut) {
  const TemporaryFolder instances, voxels;
  for (const char* name : {"a", "b"})
    instances.write(name, makeSlice({.value = name[0] == 'a' ? 5.0 : 6.0, .sopUid = "1.9.1"}));
  instances.write("c", makeSlice({.value = 7, .position = {0, 0, 2}, .sopUid = "1.9.1"}));
  const Volume one = read(instances.path());
  EXPECT_EQ(getScalars(one), (std::vector{5.0, 7.0}));
  EXPECT_EQ(countWarnings(one, ErrorCode::omittedSlices), 1u);
  for (int i = 0; i < 4; ++i)
    voxels.write(std::to_string(i), makeSlice({.value = i == 3 ? 1.0 : 1.0 * i,
                                               .position = Vec3(0, 0, i == 3 ? 2 : 2 * i),
                                               .instance = i}));
  const Volume other = read(voxels.path());
  EXPECT_EQ(getScalars(other), (std::vector{0.0, 1.0, 2.0}));
  EXPECT_EQ(countWarnings(other, ErrorCode::omittedSlices), 1u);
}

TEST(DicomLayout, MosaicsAreRefused) {
  const TemporaryFolder folder;
  folder.write("a",
               makeSlice({.more = {makeText(0x00080008, "CS", "ORIGINAL\\PRIMARY\\M\\MOSAIC")}}));
  fenestra::core::expectRefused(folder / "a", "unsupported-file", [&] { read(folder.path()); });
}

// ---- several volumes in a series

/// Writes 3 positions with `count` slices each. `more` adds elements to the k-th.
void writeRepeated(const TemporaryFolder& folder, int count,
                   const std::function<std::vector<Element>(int)>& more) {
  for (int z = 0; z < 3; ++z)
    for (int k = 0; k < count; ++k)
      folder.write(std::to_string(z) + "_" + std::to_string(count - k),
                   makeSlice({.value = 10.0 * k + z,
                              .position = Vec3(0, 0, 2 * z),
                              .instance = k * 3 + z,
                              .more = more(k)}));
}

TEST(DicomLayout, EchoesAreVolumesWithNames) {
  const TemporaryFolder folder;
  writeRepeated(folder, 2, [](int k) {
    return std::vector{makeDecimals(0x00180081, std::vector{k == 0 ? 2.46 : 4.92})};
  });
  fenestra::core::expectRefused(folder.path(),
                                "ambiguous-volume | 2 DICOM | echo 2.46 ms | echo 4.92 ms",
                                [&] { read(folder.path()); });
  EXPECT_EQ(getScalars(read(folder.path(), {.name = "echo 4.92 ms"})),
            (std::vector{10.0, 11.0, 12.0}));
  EXPECT_EQ(getScalars(read(folder.path(), {.name = "4 echo 2.46 ms"})),
            (std::vector{0.0, 1.0, 2.0}));
}

TEST(DicomLayout, DiffusionWeightsAreVolumesAlsoInPrivateTags) {
  const TemporaryFolder standard, siemens, ge;
  writeRepeated(standard, 2, [](int k) { return std::vector{makeDouble(0x00189087, 800.0 * k)}; });
  writeRepeated(siemens, 2, [](int k) {
    return std::vector{makeText(0x00190010, "LO", "SIEMENS MR HEADER"),
                       makeText(0x0019100c, "IS", std::to_string(800 * k))};
  });
  writeRepeated(ge, 2, [](int k) {
    return std::vector{makeText(0x00430010, "LO", "GEMS_PARM_01"),
                       makeText(0x00431039, "IS", std::to_string(1000000000 + 800 * k) + "\\8\\0")};
  });
  for (const TemporaryFolder* folder : {&standard, &siemens, &ge})
    EXPECT_EQ(getScalars(read(folder->path(), {.name = "b 800"})), (std::vector{10.0, 11.0, 12.0}));
}

TEST(DicomLayout, TimesAreFramesInTheirOrder) {
  const TemporaryFolder temporal, trigger, unnamed;
  writeRepeated(temporal, 3, [](int k) {
    return std::vector{makeText(0x00200100, "IS", std::to_string(9 + k))};
  });
  writeRepeated(trigger, 3, [](int k) {
    return std::vector{makeDecimals(0x00181060, std::vector{100.0 * k})};
  });
  writeRepeated(unnamed, 3, [](int) { return std::vector<Element>(); });
  for (const TemporaryFolder* folder : {&temporal, &trigger, &unnamed}) {
    const Volume first = read(folder->path());
    EXPECT_EQ(first.frameCount, 3u);
    EXPECT_EQ(getScalars(first), (std::vector{0.0, 1.0, 2.0}));
    EXPECT_EQ(countWarnings(first, ErrorCode::assumedFrame), 1u);
    EXPECT_EQ(getScalars(read(folder->path(), {.frame = 2})), (std::vector{20.0, 21.0, 22.0}));
  }
  fenestra::core::expectRefused(unnamed.path(), "unknown-frame",
                                [&] { read(unnamed.path(), {.frame = 3}); });
}

TEST(DicomLayout, AnAbortedLastTimeIsLeftOut) {
  const TemporaryFolder folder;
  writeRepeated(folder, 3,
                [](int k) { return std::vector{makeText(0x00200100, "IS", std::to_string(k))}; });
  folder.write("last", makeSlice({.value = 30, .more = {makeText(0x00200100, "IS", "3")}}));
  const Volume volume = read(folder.path());
  EXPECT_EQ(volume.frameCount, 3u);
  EXPECT_EQ(countWarnings(volume, ErrorCode::omittedSlices), 1u);
}

/// Elements of a phase: temporal position, acquisition and acquisition time, unless negative.
std::vector<Element> makePhase(int temporal, int acquisition, int time) {
  std::vector<Element> more = {makeDecimals(0x00180050, std::vector{2.0})};
  if (temporal >= 0)
    more.push_back(makeText(0x00200100, "IS", std::to_string(temporal)));
  if (acquisition >= 0)
    more.push_back(makeText(0x00200012, "IS", std::to_string(acquisition)));
  if (time >= 0)
    more.push_back(makeText(0x00080032, "TM", std::to_string(102000 + time)));
  return more;
}

/// Writes slices 2 mm thick with the values `first`, `first` + 1, ...
void writePhase(const TemporaryFolder& folder, int first, const std::vector<double>& depths,
                const std::vector<Element>& more) {
  for (std::size_t i = 0; i < depths.size(); ++i) {
    const int value = first + static_cast<int>(i);
    folder.write(
        std::to_string(value),
        makeSlice({.value = 1.0 * value, .position = Vec3(0, 0, depths[i]), .more = more}));
  }
}

TEST(DicomLayout, PhasesWhosePositionsInterleaveAreFrames) {
  for (const auto& [temporal, acquisition, time] :
       {std::array{1, -1, -1}, std::array{-1, 1, -1}, std::array{-1, -1, 1}})
    for (const double shift : {1.0, 0.7, 0.02}) { // half a slice, others, jitter
      const TemporaryFolder folder;
      for (const int k : {0, 1})
        writePhase(folder, 10 * k, {0 + k * shift, 2 + k * shift, 4 + k * shift, 6 + k * shift},
                   makePhase(temporal * k, acquisition * k, time * k));
      for (const std::size_t k : {0U, 1U}) {
        const Volume volume = read(folder.path(), {.frame = k});
        EXPECT_EQ(volume.frameCount, 2u);
        EXPECT_EQ(getScalar(volume, 3), 2.0 * (10.0 * static_cast<double>(k) + 3) - 1000.0);
        EXPECT_EQ(volume.grid.size.z(), 4);
        EXPECT_TRUE(volume.warnings.empty());
      }
    }
}

TEST(DicomLayout, AShorterAcquisitionBetweenTheSlicesIsAFrame) {
  const TemporaryFolder folder;
  writePhase(folder, 0, {0, 2, 4, 6, 8, 10}, makePhase(-1, 1, 0));
  writePhase(folder, 10, {3.2, 5.2, 7.2}, makePhase(-1, 2, 60));
  EXPECT_EQ(getScalars(read(folder.path(), {.frame = 0})),
            (std::vector{0.0, 1.0, 2.0, 3.0, 4.0, 5.0}));
  EXPECT_EQ(getScalars(read(folder.path(), {.frame = 1})), (std::vector{10.0, 11.0, 12.0}));
}

TEST(DicomLayout, AcquisitionsOfOneVolumeStayTogether) {
  const TemporaryFolder parts, odd;
  writePhase(parts, 0, {0, 2, 4, 6}, makePhase(-1, 1, 0));
  writePhase(parts, 10, {8, 10, 12}, makePhase(-1, 2, 60));
  writePhase(parts, 20, {14, 16, 18}, makePhase(-1, 3, 90));
  writePhase(odd, 0, {0, 4, 8, 12}, makePhase(-1, 1, 0)); // odd slices are scanned first
  writePhase(odd, 10, {2, 6, 10}, makePhase(-1, 1, 60));
  for (const TemporaryFolder* folder : {&parts, &odd}) {
    const Volume volume = read(folder->path());
    EXPECT_EQ(volume.frameCount, 1u);
    EXPECT_EQ(volume.grid.size.z(), folder == &parts ? 10 : 7);
    EXPECT_TRUE(volume.warnings.empty());
  }
}

TEST(DicomLayout, AcquisitionsMayShareTheirEnds) {
  const TemporaryFolder folder;
  writePhase(folder, 0, {0, 2, 4, 6}, makePhase(-1, 1, 0));
  writePhase(folder, 10, {6, 8, 10}, makePhase(-1, 2, 60));
  const Volume volume = read(folder.path());
  EXPECT_EQ(getScalars(volume), (std::vector{0.0, 1.0, 2.0, 3.0, 11.0, 12.0}));
  ASSERT_EQ(volume.warnings.size(), 1u);
  expectMessage(volume.warnings[0], "omitted-slices | 1 of 7");
}

TEST(DicomLayout, KernelsAreVolumes) {
  const TemporaryFolder folder;
  writeRepeated(folder, 2, [](int k) {
    return std::vector{makeText(0x00181210, "SH", k == 0 ? "B30f" : "I70f\\2")};
  });
  fenestra::core::expectRefused(folder.path(), "ambiguous-volume | kernel B30f | kernel I70f/2",
                                [&] { read(folder.path()); });
  EXPECT_EQ(getScalars(read(folder.path(), {.name = "kernel I70f/2"})),
            (std::vector{10.0, 11.0, 12.0}));
}

TEST(DicomLayout, AKeyThatVariesFromSliceToSliceDividesNothing) {
  const TemporaryFolder folder;
  for (int i = 0; i < 4; ++i)
    folder.write(std::to_string(i),
                 makeSlice({.value = 1.0 * i,
                            .position = Vec3(0, 0, i),
                            .more = {makeDecimals(0x00181060, std::vector{10.0 * i})}}));
  const Volume volume = read(folder.path());
  EXPECT_EQ(volume.frameCount, 1u);
  EXPECT_EQ(volume.grid.size.z(), 4);
  EXPECT_TRUE(volume.warnings.empty());
}

TEST(DicomLayout, SlicesAtOnePositionThatNothingDistinguishesAreRefused) {
  const TemporaryFolder folder;
  writeDepths(folder, {0, 2, 4, 2});
  fenestra::core::expectRefused(folder / "1", "invalid-field: ImagePositionPatient | 3",
                                [&] { read(folder.path()); });
}

// ---- incomplete and uneven series

TEST(DicomLayout, AMissingSliceIsInterpolated) {
  const TemporaryFolder folder;
  writeDepths(folder, {10, 12, 14, 18, 20});
  const Volume volume = read(folder.path());
  EXPECT_EQ(getScalars(volume), (std::vector{0.0, 1.0, 2.0, 2.5, 3.0, 4.0}));
  EXPECT_TRUE(isApprox(volume.grid.indexToWorld.linear().col(2), Vec3(0, 0, 2)));
  EXPECT_TRUE(isApprox(volume.grid.indexToWorld.translation(), Vec3(0, 0, 10)));
  ASSERT_EQ(volume.warnings.size(), 1u);
  expectMessage(volume.warnings[0], "interpolated-slices | 4 mm between 14 and 18 mm | 1 slice");
}

TEST(DicomLayout, UnevenSlicesAreResampledAtTheSmallestDistance) {
  const TemporaryFolder folder;
  writeDepths(folder, {0, 3, 6, 9, 15, 21, 27});
  const Volume volume = read(folder.path());
  EXPECT_EQ(getScalars(volume), (std::vector{0.0, 1.0, 2.0, 3.0, 3.5, 4.0, 4.5, 5.0, 5.5, 6.0}));
  EXPECT_NEAR(volume.grid.spacing().z(), 3.0, 1e-9);
  const TemporaryFolder irregular; // no common step
  writeDepths(irregular, {0, 2, 4, 6, 9.1});
  const Volume other = read(irregular.path());
  EXPECT_EQ(other.grid.size.z(), 6); // ceil(9.1 / 2) steps
  EXPECT_NEAR(other.grid.spacing().z(), 9.1 / 5, 1e-9);
  EXPECT_EQ(getScalars(other).back(), 4.0);
}

TEST(DicomLayout, AGapTooLargeToFillIsRefused) {
  const TemporaryFolder folder;
  writeDepths(folder, {0, 1, 2, 300});
  fenestra::core::expectRefused(folder / "2", "invalid-field: ImagePositionPatient | 298 mm",
                                [&] { read(folder.path()); });
}

TEST(DicomLayout, DeflatedSlicesAreRead) {
  const TemporaryFolder folder;
  folder.write("a", makeSlice({.value = 3}, Syntax::deflated));
  EXPECT_EQ(getScalars(read(folder.path())), std::vector{3.0});
}

} // namespace
} // namespace fenestra::core::DicomLayoutTests
