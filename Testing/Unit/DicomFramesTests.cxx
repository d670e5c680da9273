// Multi-frame DICOM files, stored values of voxels, and values of PET.

#include "Approx.h"
#include "DicomSliceFiles.h"
#include "files/medical/StandardUptake.h"

#include <random>

namespace fenestra::core::DicomFramesTests {
namespace {

using namespace dicomSlices;

TEST(DicomFrames, FramesOfAMultiFrameFileAreSlices) {
  const Mat3 axes = (makeRotation(0.4, Vec3(1, 2, 3).normalized())).linear();
  const Vec3 origin(10, -20, 30);
  for (const Syntax syntax : {Syntax::explicitLittle, Syntax::implicitLittle, Syntax::explicitBig,
                              Syntax::deflated, Syntax::rle})
    for (const bool hasLengths : {true, false}) {
      const TemporaryFolder folder;
      folder.write("frames", makeFrames(
                                 5, // against the normal
                                 [&](unsigned i) {
                                   return Item{makePosition(origin + axes * Vec3(0, 0, -2.5 * i))};
                                 },
                                 {makeShared(axes)}, syntax, hasLengths));
      const Volume volume = read(folder.path());
      EXPECT_EQ(getScalars(volume), (std::vector{4.0, 3.0, 2.0, 1.0, 0.0}));
      EXPECT_TRUE(volume.warnings.empty());
      for (const Vec3& corner : {Vec3(0, 0, 0), Vec3(2, 1, 0), Vec3(0, 1, 4)}) {
        const Vec3 lps =
            origin + axes * Vec3(0.5 * corner[0], 2.0 * corner[1], 2.5 * (corner[2] - 4));
        EXPECT_LT((volume.grid.indexToWorld * corner - Vec3(-lps[0], -lps[1], lps[2])).norm(),
                  1e-4);
      }
    }
}

TEST(DicomFrames, FramesCanDifferInEchoAndTime) {
  const TemporaryFolder folder;
  folder.write(
      "frames",
      makeFrames(12,
                 [](unsigned i) {
                   const std::uint32_t time = 1 - i / 6; // not the order of the frames
                   return Item{
                       makeSequence(0x00189114, {{makeDouble(0x00189082, i % 2 ? 30.0 : 10.0)}}),
                       makeSequence(0x00209111,
                                    {{{0x00209128, "UL",
                                       std::string(reinterpret_cast<const char*>(&time), 4)}}}),
                       makePosition(Vec3(0, 0, 2.0 * (i / 2 % 3)))};
                 },
                 {makeShared(Mat3::Identity())}));
  EXPECT_EQ(getScalars(read(folder.path(), {.name = "echo 30 ms", .frame = 1})),
            (std::vector{1.0, 3.0, 5.0}));
  EXPECT_EQ(findSeriesOfFile(folder / "frames").series.size(), 2u);
}

TEST(DicomFrames, FramesWithoutPositionsFollowTheStatedSpacing) {
  const TemporaryFolder stated, thickness;
  const auto write = [&](const TemporaryFolder& folder, std::uint32_t tag, double step) {
    folder.write(
        "nm", makeFrames(3, nullptr,
                         {makeText(0x00080016, "UI", "1.2.840.10008.5.1.4.1.1.20"),
                          makeText(0x00080060, "CS", "NM"), makeDecimals(tag, std::vector{step}),
                          makeDecimals(0x00280030, std::vector{2.0, 0.5}),
                          makeSequence(0x00540022,
                                       {{makeDecimals(0x00200032, std::vector{1.0, 2.0, 3.0}),
                                         makeDecimals(0x00200037, toCosines(Mat3::Identity()))}}),
                          makeShorts(0x00540080, {1, 2, 3})}));
    return read(folder.path());
  };
  const Volume volume = write(stated, 0x00180088, -4.0); // against the normal
  EXPECT_EQ(getScalar(volume, 0), 2.0);
  EXPECT_TRUE(isApprox(volume.grid.indexToWorld * Vec3(0, 0, 0), Vec3(-1, -2, -5)));
  EXPECT_TRUE(volume.warnings.empty());
  const Volume other = write(thickness, 0x00180050, 4.0);
  EXPECT_TRUE(isApprox(other.grid.indexToWorld * Vec3(0, 0, 2), Vec3(-1, -2, 11)));
  EXPECT_EQ(countWarnings(other, ErrorCode::assumedGeometry), 1u);
}

TEST(DicomFrames, FramesBeyondTheFileAreRefused) {
  const TemporaryFolder folder;
  const std::string bytes =
      makeFrames(4, [](unsigned i) { return Item{makePosition(Vec3(0, 0, i))}; },
                 {makeShared(Mat3::Identity())});
  const Path file = folder.write("frames", bytes.substr(0, bytes.size() - 14));
  fenestra::core::expectRefused(file, "damaged-file: PixelData", [&] { read(folder.path()); });
}

// ---- voxels

/// Stored value by DICOM PS3.5, 8.1.1: the bits up to HighBit, with the sign of the highest.
double decode(const DicomHeader& h, std::uint32_t word) {
  double value = 0.0;
  for (unsigned bit = 0; bit < h.bitsStored; ++bit)
    if (word >> (h.highBit + 1 - h.bitsStored + bit) & 1U)
      value += std::exp2(bit) * (h.isSigned && bit + 1 == h.bitsStored ? -1.0 : 1.0);
  return h.slope * value + h.intercept;
}

TEST(DicomVoxels, StoredBitsAreExtendedAndRescaled) {
  std::mt19937 random(3); // NOLINT: reproducible
  for (const auto& [bits, stored, highBit] : std::vector<std::array<unsigned, 3>>{{8, 8, 7},
                                                                                  {8, 5, 6},
                                                                                  {16, 16, 15},
                                                                                  {16, 12, 11},
                                                                                  {16, 12, 15},
                                                                                  {16, 1, 0},
                                                                                  {32, 32, 31},
                                                                                  {32, 20, 24}})
    for (const unsigned isSigned : {0U, 1U})
      for (const auto& [slope, intercept] : std::vector<std::pair<double, double>>{{1, 0},
                                                                                   {1, -1024},
                                                                                   {-1, 100},
                                                                                   {2, 0.5},
                                                                                   {0.25, 0},
                                                                                   {40000, 7},
                                                                                   {1e12, -1},
                                                                                   {0, 3}}) {
        DicomHeader h;
        h.rows = 4;
        h.columns = 16;
        h.bits = bits;
        h.bitsStored = stored;
        h.highBit = highBit;
        h.isSigned = isSigned;
        h.slope = slope;
        h.intercept = intercept;
        std::string voxels;
        std::vector<double> expected;
        for (int i = 0; i < 64; ++i) {
          const auto word = static_cast<std::uint32_t>(i == 0 ? ~0U : random());
          voxels.append(reinterpret_cast<const char*>(&word), bits / 8);
          expected.push_back(decode(h, word));
        }
        SCOPED_TRACE(concat(bits, ' ', stored, ' ', highBit, ' ', toString(slope)));
        std::visit(
            [&](const auto& scalars) {
              EXPECT_EQ(std::vector<double>(scalars.begin(), scalars.end()), expected);
            },
            rescaleVoxels(h, voxels));
      }
}

// ---- PET

/// 70 kg, 350 MBq of fluorine-18 injected at 10:00, series at 11:00.
DicomHeader makePet() {
  DicomHeader h;
  h.units = "BQML";
  h.decayCorrection = "START";
  h.seriesDate = "20240301";
  h.seriesTime = "110000.00";
  h.injectionTime = "100000";
  h.weight = 70.0;
  h.dose = 3.5e8;
  h.halfLife = 6586.2;
  return h;
}

TEST(StandardUptake, DoseDecaysFromTheInjectionToTheSeries) {
  std::string fault;
  DicomHeader h = makePet();
  const double atInjection = 70e3 / 3.5e8, decay = std::exp2(3600.0 / 6586.2);
  EXPECT_NEAR(computeSuvFactor(h, fault).value(), atInjection * decay, 1e-12);
  h.injectionDateTime = "20240229230000.0+0100"; // the day before, in a leap year
  EXPECT_NEAR(computeSuvFactor(h, fault).value(), atInjection * std::exp2(12 * 3600.0 / 6586.2),
              1e-9);
  h.injectionDateTime = "";
  h.seriesTime = "003000"; // past midnight
  h.injectionTime = "233000";
  EXPECT_NEAR(computeSuvFactor(h, fault).value(), atInjection * decay, 1e-12);
  h.decayCorrection = "ADMIN";
  EXPECT_NEAR(computeSuvFactor(h, fault).value(), atInjection, 1e-12);
}

TEST(StandardUptake, IncompleteHeadersGiveNoFactor) {
  std::string fault;
  const auto expectNone = [&](auto member, const auto& value) {
    DicomHeader h = makePet();
    h.*member = value;
    EXPECT_FALSE(computeSuvFactor(h, fault));
  };
  expectNone(&DicomHeader::units, "CNTS");
  expectNone(&DicomHeader::decayCorrection, "NONE");
  expectNone(&DicomHeader::injectionTime, "");
  expectNone(&DicomHeader::seriesTime, "noon");
  expectNone(&DicomHeader::weight, std::nullopt);
  expectNone(&DicomHeader::dose, 0.0);
  expectNone(&DicomHeader::halfLife, std::nullopt);
  EXPECT_NE(fault.find("RadionuclideHalfLife"), std::string::npos);
}

TEST(StandardUptake, ImplausibleValuesGiveNoFactor) {
  std::string fault;
  const auto expectNone = [&](auto member, double value, const char* text) {
    DicomHeader h = makePet();
    h.*member = value;
    EXPECT_FALSE(computeSuvFactor(h, fault));
    EXPECT_NE(fault.find(text), std::string::npos) << fault;
  };
  expectNone(&DicomHeader::dose, 370.0, "370 Bq"); // MBq
  expectNone(&DicomHeader::dose, 0.0, "0 Bq");
  expectNone(&DicomHeader::weight, 70000.0, "70000 kg"); // g
  expectNone(&DicomHeader::weight, -1.0, "-1 kg");
}

TEST(StandardUptake, TheFirstAcquisitionPrecedesAProcessedSeries) {
  std::string fault;
  const double atInjection = 70e3 / 3.5e8, decay = std::exp2(3600.0 / 6586.2);
  DicomHeader h = makePet();
  h.acquisitionTime = 110000.0;
  h.acquisitionDate = "20240301";
  h.seriesTime = "115900"; // processed later
  EXPECT_NEAR(computeSuvFactor(h, fault).value(), atInjection * decay, 1e-12);
  h.seriesDate = "20240303"; // without a date of the injection
  EXPECT_NEAR(computeSuvFactor(h, fault).value(), atInjection * decay, 1e-12);
  h.injectionDateTime = "20240301100000";
  EXPECT_NEAR(computeSuvFactor(h, fault).value(), atInjection * decay, 1e-12);
  h = makePet();
  h.acquisitionTime = 113000.0; // of a later bed position
  EXPECT_NEAR(computeSuvFactor(h, fault).value(), atInjection * decay, 1e-12);
}

TEST(StandardUptake, TheFirstAcquisitionIsSearchedInAllSlices) {
  DicomSeries series;
  for (const double time : {103000.0, 100000.0, 110000.0}) {
    DicomHeader h = makePet();
    h.acquisitionTime = time;
    series.frames.push_back({{"a", h}});
  }
  std::vector<Message> warnings;
  DicomSlices slices = series.frames[0];
  convertToSuv(slices, series, "x", warnings);
  EXPECT_NEAR(slices[0].header.slope, 70e3 / 3.5e8, 1e-12);
  EXPECT_TRUE(warnings.empty());
}

TEST(StandardUptake, VoxelsOfAPetAreSuv) {
  const TemporaryFolder folder;
  const auto write = [&](const std::string& units) {
    folder.write(
        "a",
        makeSlice(
            {.value = 5000,
             .more = {makeText(0x00080060, "CS", "PT"), makeDecimals(0x00101030, std::vector{70.0}),
                      makeDecimals(0x00281052, std::vector{0.0}),
                      makeSequence(0x00540016, {{makeDecimals(0x00181074, std::vector{3.5e8})}}),
                      makeText(0x00541001, "CS", units), makeText(0x00541102, "CS", "ADMIN")}}));
    return read(folder.path());
  };
  const Volume suv = write("BQML");
  EXPECT_EQ(suv.modality, Modality::pt);
  EXPECT_NEAR(suv.maximum, 10000.0 * 70e3 / 3.5e8, 1e-6);
  EXPECT_TRUE(suv.warnings.empty()) << "nothing is assumed";
  const Volume counts = write("CNTS");
  EXPECT_EQ(counts.maximum, 10000.0);
  expectMessage(counts.warnings.at(0), "assumed-units | BQML");
  const Volume ready = write("GML");
  EXPECT_EQ(ready.maximum, 10000.0);
  EXPECT_TRUE(ready.warnings.empty());
}

} // namespace
} // namespace fenestra::core::DicomFramesTests
