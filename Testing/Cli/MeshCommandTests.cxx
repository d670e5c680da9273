// `fenestra mesh`: the focus as triangles.

#include "CommandTesting.h"
#include "base/Vector.h"

#include <cstring>
#include <fstream>

namespace fenestra::core::MeshCommandTests {
namespace {

const Arguments cartilage = {"mesh", "knee/knee.mrml", "--focus", "FemoralCartilage", "--quiet"};

Arguments makeArguments(const Arguments& more) {
  Arguments all = cartilage;
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

/// Triangles of a binary .stl: 84 bytes of header, then facets of 50 bytes.
std::size_t countFacets(const std::filesystem::path& stl) {
  return (std::filesystem::file_size(stl) - 84) / 50;
}

/// Volume that the triangles of a binary .stl enclose, mm³.
double findVolume(const std::filesystem::path& stl) {
  const std::string bytes = readBytes(stl);
  double volume = 0.0;
  for (std::size_t facet = 0; facet < countFacets(stl); ++facet) {
    std::array<float, 12> numbers; // normal and corners
    std::memcpy(numbers.data(), &bytes[84 + 50 * facet], sizeof numbers);
    const auto corner = [&](std::size_t i) {
      return Vec3(double{numbers[3 * i]}, double{numbers[3 * i + 1]}, double{numbers[3 * i + 2]});
    };
    volume += corner(1).dot(corner(2).cross(corner(3))) / 6.0;
  }
  return volume;
}

class MeshCommand : public ::testing::Test {
protected:
  Outcome write(const Arguments& more) const {
    return run(makeArguments(more), kneeFolder().path());
  }
  std::string outputPath(const std::string& name) const { return (folder / name).string(); }

  TemporaryFolder folder;
};

TEST_F(MeshCommand, WritesTheSameTrianglesInEveryFormat) {
  for (const char* name : {"a.ply", "a.vtp", "a.stl"}) {
    const Outcome outcome = write({"--output", outputPath(name)});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(outcome.out + outcome.err, "");
  }
  const std::string count = std::to_string(countFacets(folder / "a.stl"));
  EXPECT_NE(readBytes(folder / "a.ply").find("element face " + count + "\n"), std::string::npos);
  EXPECT_NE(readBytes(folder / "a.vtp").find("NumberOfPolys=\"" + count + "\""), std::string::npos);
}

/// Smoothing and margin change the triangles as they change the focus of an image.
TEST_F(MeshCommand, FollowsTheOptionsOfTheFocus) {
  ASSERT_EQ(write({"--output", outputPath("raw.stl"), "--label-smoothing", "0"}).status, 0);
  ASSERT_EQ(write({"--output", outputPath("smooth.stl")}).status, 0);
  ASSERT_EQ(write({"--output", outputPath("grown.stl"), "--margin", "2"}).status, 0);
  const double smooth = findVolume(folder / "smooth.stl");
  EXPECT_GT(smooth, 5000.0);
  EXPECT_NE(findVolume(folder / "raw.stl"), smooth);
  EXPECT_GT(findVolume(folder / "grown.stl"), 1.3 * smooth);
}

/// What readers assume about a file is a warning, as for an image: the mesh may lie elsewhere.
TEST_F(MeshCommand, WarnsOfAssumptions) {
  std::string voxels(8 * 8 * 8, '\0');
  voxels[3 * 64 + 3 * 8 + 3] = 1;
  std::ofstream(folder / "labels.nrrd") << "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 8 8 8\n"
                                           "encoding: raw\n\n"
                                        << voxels;
  const Outcome outcome = run({"mesh", "labels.nrrd", "-s", "labels.nrrd", "--focus", "1",
                               "--label-smoothing", "0", "-o", "a.stl"},
                              folder.path());
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("fenestra: warning: labels.nrrd"), std::string::npos) << outcome.err;
}

TEST_F(MeshCommand, RejectsWhatItCannotWrite) {
  std::filesystem::create_directory_symlink(kneeFolder() / "knee", folder / "knee");
  expectErrors(
      {{"no output", cartilage, 2, "--output: "},
       {"no focus", {"mesh", "knee/knee.nrrd", "-o", "a.stl"}, 2, "--focus: "},
       {"unknown segment", {"mesh", "knee/knee.mrml", "--focus", "Nose", "-o", "a.stl"}, 3, "Nose"},
       {"unknown extension", makeArguments({"-o", "a.obj"}), 2, "a.obj: "},
       {"option of an image", makeArguments({"--exposure", "1"}), 2, "--exposure"}},
      folder.path());
}

} // namespace
} // namespace fenestra::core::MeshCommandTests
