#include "ErrorChecks.h"
#include "phantoms/PhantomWriter.h"
#include "phantoms/Phantoms.h"

#include "Approx.h"
#include <algorithm>
#include <gtest/gtest.h>
#include <itkMetaDataObject.h>
#include <itkNrrdImageIO.h>
#include <nlohmann/json.hpp>

#include <fstream>

namespace fenestra::core::PhantomWriterTests {
namespace {

struct PhantomFiles : ::testing::Test {
  std::filesystem::path folder = std::filesystem::path(::testing::TempDir()) /
                                 ::testing::UnitTest::GetInstance()->current_test_info()->name() /
                                 "deeper";
  Phantom phantom = makeKneePhantom({32, 36, 24});

  void SetUp() override {
    std::filesystem::remove_all(folder.parent_path());
    writePhantom(phantom, folder, "knee");
  }
  void TearDown() override { std::filesystem::remove_all(folder.parent_path()); }

  itk::NrrdImageIO::Pointer open(const std::string& name) const {
    const auto io = itk::NrrdImageIO::New();
    io->SetFileName((folder / name).string());
    io->ReadImageInformation();
    return io;
  }
};

template <typename T>
std::vector<T> read(itk::NrrdImageIO& io) {
  std::vector<T> values(static_cast<std::size_t>(io.GetImageSizeInPixels()));
  io.Read(values.data());
  return values;
}

std::string readField(const itk::NrrdImageIO& io, const std::string& key) {
  std::string value;
  itk::ExposeMetaData<std::string>(io.GetMetaDataDictionary(), key, value);
  return value;
}

/// Position of a voxel from the file header, converted from LPS to RAS.
Vec3 computeVoxelPosition(const itk::NrrdImageIO& io, const Vec3& index) {
  Vec3 lps;
  for (unsigned axis = 0; axis < 3; ++axis)
    lps[axis] = io.GetOrigin(axis);
  for (unsigned axis = 0; axis < 3; ++axis)
    for (unsigned row = 0; row < 3; ++row)
      lps[row] += io.GetDirection(axis)[row] * io.GetSpacing(axis) * index[axis];
  return {-lps.x(), -lps.y(), lps.z()};
}

TEST_F(PhantomFiles, VoxelsAndPositionOfVolumeRoundTrip) {
  const auto io = open("knee.nrrd");
  EXPECT_EQ(readField(*io, "NRRD_space"), "left-posterior-superior");
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 index = Box{Vec3::Zero(), phantom.volume.grid.size.cast<double>()}.corner(corner);
    EXPECT_TRUE(
        isApprox(computeVoxelPosition(*io, index), phantom.volume.grid.indexToWorld * index, 1e-9));
  }
  EXPECT_TRUE(std::ranges::equal(read<std::int16_t>(*io),
                                 std::get<LargeArray<std::int16_t>>(phantom.volume.voxels)));
}

TEST_F(PhantomFiles, SegmentationHasSlicerFieldsForEverySegment) {
  const auto io = open("knee.seg.nrrd");
  const std::vector<std::uint8_t> labels = read<std::uint8_t>(*io);
  EXPECT_EQ(labels, phantom.labels.layers.at(0));
  EXPECT_TRUE(isApprox(computeVoxelPosition(*io, {1, 2, 3}),
                       phantom.volume.grid.indexToWorld * Vec3(1, 2, 3), 1e-9));
  EXPECT_EQ(readField(*io, "Segmentation_MasterRepresentation"), "Binary labelmap");
  for (std::size_t i = 0; i < phantom.segments.size(); ++i) {
    const std::string prefix = "Segment" + std::to_string(i) + "_";
    EXPECT_EQ(readField(*io, prefix + "ID"), phantom.segments[i].id);
    EXPECT_EQ(readField(*io, prefix + "Name"), phantom.segments[i].name);
    EXPECT_EQ(readField(*io, prefix + "LabelValue"), std::to_string(phantom.segments[i].label));
    EXPECT_EQ(readField(*io, prefix + "Layer"), "0");
    EXPECT_FALSE(readField(*io, prefix + "Tags").empty());
  }
  EXPECT_EQ(readField(*io, "Segment" + std::to_string(phantom.segments.size()) + "_ID"), "");
}

// Slicer crops a complete layer to the extent of its first segment.
TEST_F(PhantomFiles, ExtentOfSegmentCoversLayer) {
  const std::string first = readField(*open("knee.seg.nrrd"), "Segment0_Extent");
  EXPECT_EQ(readField(*open("knee.seg.nrrd"), "Segment3_Extent"), first);
  std::istringstream text(first);
  std::array<std::int64_t, 6> extent;
  for (std::int64_t& value : extent)
    text >> value;
  Size3 bounds[2] = {phantom.volume.grid.size, Size3::Zero()}; // first and last
  const auto extend = [&bounds](const Size3& voxel) {
    bounds[0] = bounds[0].cwiseMin(voxel);
    bounds[1] = bounds[1].cwiseMax(voxel);
  };
  const Size3& size = phantom.volume.grid.size;
  for (std::int64_t at = 0; at < size.prod(); ++at)
    if (phantom.labels.layers[0][static_cast<std::size_t>(at)] != 0)
      extend({at % size.x(), at / size.x() % size.y(), at / (size.x() * size.y())});
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_EQ(extent[2 * static_cast<std::size_t>(axis)], bounds[0][axis]);
    EXPECT_EQ(extent[2 * static_cast<std::size_t>(axis) + 1], bounds[1][axis]);
  }
}

TEST_F(PhantomFiles, PropertyIsSlicerJson) {
  std::ifstream file(folder / "knee.vp.json");
  const nlohmann::json json = nlohmann::json::parse(file);
  EXPECT_NE(json.at("@schema").get<std::string>().find("volume-property-schema-v1.0.0.json#"),
            std::string::npos);
  const auto& component = json.at("volumeProperties").at(0).at("components").at(0);
  EXPECT_EQ(component.at("shade"), phantom.property.shade);
  EXPECT_EQ(component.at("scalarOpacityUnitDistance"), phantom.property.unitDistance);
  const auto& opacity = component.at("scalarOpacity").at("points");
  ASSERT_EQ(opacity.size(), phantom.property.scalarOpacity.size());
  for (std::size_t i = 0; i < opacity.size(); ++i) {
    EXPECT_EQ(opacity[i].at("x"), phantom.property.scalarOpacity[i].x);
    EXPECT_EQ(opacity[i].at("y"), phantom.property.scalarOpacity[i].value);
  }
  EXPECT_EQ(component.at("rgbTransferFunction").at("points").size(), phantom.property.color.size());
}

TEST_F(PhantomFiles, SevenFilesAreWritten) {
  std::size_t count = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder))
    ++count;
  EXPECT_EQ(count, 7u);
}

std::string readContent(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Removes the provenance tags, which earlier versions did not write.
void removeTags(const std::filesystem::path& folder) {
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    std::string text = readContent(entry.path());
    const std::size_t tag = text.find("Written by Fenestra");
    if (tag == std::string::npos)
      continue;
    const std::size_t line = text.rfind('\n', tag) + 1;
    text.erase(line, text.find('\n', tag) + 1 - line);
    std::ofstream(entry.path(), std::ios::binary) << text;
  }
}

TEST_F(PhantomFiles, FilesOfEarlierPhantomsAreReplaced) {
  writePhantom(phantom, folder, "knee");
  writePhantom(makeKneePhantom({24, 28, 16}), folder, "knee"); // recognized by tags
  writePhantom(phantom, folder, "knee");
  removeTags(folder);
  writePhantom(phantom, folder, "knee"); // recognized by volume and scene
}

TEST_F(PhantomFiles, EditedFilesAreNotReplaced) {
  for (const char* name : {"knee.vp.json", "knee-roi.mrk.json", "knee.mrml"}) {
    writePhantom(phantom, folder, "knee");
    const std::string edited = readContent(folder / name) + "\n";
    std::ofstream(folder / name, std::ios::binary) << edited;
    EXPECT_THROW(writePhantom(phantom, folder, "knee"), Error) << name;
    EXPECT_EQ(readContent(folder / name), edited);
    std::filesystem::remove(folder / name);
  }
}

TEST_F(PhantomFiles, FilesOfOtherProgramsAreNotReplaced) {
  for (const char* name : {"knee.nrrd", "knee.seg.nrrd", "knee.vp.json", "knee.vp",
                           "knee-roi.mrk.json", "knee.mrml", "knee.mrb"}) {
    std::filesystem::remove_all(folder);
    std::filesystem::create_directory(folder);
    std::ofstream(folder / name) << "another program's";
    catchError(ErrorKind::request, std::string("foreign-output: ") + name,
               [&] { writePhantom(phantom, folder, "knee"); });
    EXPECT_EQ(readContent(folder / name), "another program's");
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 1);
  }
}

TEST_F(PhantomFiles, FolderThatCannotBeCreatedIsOutputError) {
  const auto file = folder / "knee.nrrd";
  catchError(ErrorKind::output, "unwritable-file | " + file.string(),
             [&] { writePhantom(phantom, file / "inside", "knee"); });
}

} // namespace
} // namespace fenestra::core::PhantomWriterTests
