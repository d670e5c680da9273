// `--surface`: the clipping surface as a mesh, errors, and remaining files.

#include "CommandTesting.h"
#include "files/images/ImageReader.h"

#include <pugixml.hpp>

#include <cmath>
#include <cstring>
#include <sstream>

namespace fenestra::core::SurfaceCommandTests {
namespace {

const Arguments knee = {"knee/knee.nrrd", "--segmentation",   "knee/knee.seg.nrrd",
                        "--focus",        "FemoralCartilage", "--size",
                        "48x40",          "--samples",        "1"};

Arguments makeKneeArguments(const Arguments& more) {
  Arguments all = knee;
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

/// Content of a .ply written by Fenestra: x, y, z and depth per vertex, and the number of faces.
struct PlyContent {
  std::vector<std::array<float, 4>> vertices;
  std::size_t faces = 0;
};

PlyContent readPly(const std::filesystem::path& path) {
  const std::string bytes = readBytes(path);
  const auto numberAfter = [&](const std::string& words) {
    return std::stoul(bytes.substr(bytes.find(words) + words.size(), 9));
  };
  PlyContent content;
  content.vertices.resize(numberAfter("element vertex "));
  content.faces = numberAfter("element face ");
  const std::string last = "end_header\n";
  const std::size_t begin = bytes.find(last) + last.size();
  // Bytes: four floats per vertex; a count and three 32-bit indices per face.
  EXPECT_EQ(bytes.size(), begin + 16 * content.vertices.size() + 13 * content.faces);
  std::memcpy(content.vertices.data(), bytes.data() + begin, 16 * content.vertices.size());
  return content;
}

class SurfaceCommand : public ::testing::TestWithParam<const char*> {
protected:
  /// Renders the knee.
  Outcome render(const Arguments& more) const {
    return run(makeKneeArguments(more), kneeFolder().path());
  }
  std::string outputPath(const std::string& name) const { return (folder / name).string(); }

  TemporaryFolder folder;
};

TEST_P(SurfaceCommand, WritesTheSameMeshInEveryFormat) {
  const auto surfaceArguments = [&](const std::string& name) {
    return Arguments{"--clip",    GetParam(),      "--output", outputPath("a.exr"),
                     "--surface", outputPath(name)};
  };
  for (const char* name : {"a.ply", "a.vtp", "a.STL"}) {
    const Outcome outcome = render(surfaceArguments(name));
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
  }
  EXPECT_EQ(listFiles(folder.path()), (std::set<std::string>{"a.exr", "a.ply", "a.vtp", "a.STL"}));

  const PlyContent ply = readPly(folder / "a.ply");
  EXPECT_GT(ply.faces, 100u);
  pugi::xml_document vtp;
  ASSERT_TRUE(vtp.load_file(outputPath("a.vtp").c_str()));
  const pugi::xml_node piece = vtp.select_node("/VTKFile/PolyData/Piece").node();
  EXPECT_EQ(piece.attribute("NumberOfPoints").as_ullong(), ply.vertices.size());
  EXPECT_EQ(piece.attribute("NumberOfPolys").as_ullong(), ply.faces);
  EXPECT_TRUE(vtp.select_node("//PointData/DataArray[@Name='depth']"));
  EXPECT_EQ(std::filesystem::file_size(folder / "a.STL"), 84 + 50 * ply.faces); // header, facets
}

TEST_P(SurfaceCommand, MeshHasTheDepthsOfTheClipChannel) {
  ASSERT_EQ(render({"--clip", GetParam(), "--view", "left", "--scale", "30", "--output",
                    outputPath("a.exr"), "--surface", outputPath("a.ply")})
                .status,
            0);
  const Image image = readImage(folder / "a.exr");
  const std::vector<float>& clip = image.channels.at("clip.Z");
  std::istringstream camera(image.header.at("camera"));
  std::array<double, 3> position{};
  for (std::string word; camera >> word;)
    if (word.starts_with("--position="))
      std::sscanf(word.c_str(), "--position=%lf,%lf,%lf", &position[0], &position[1], &position[2]);
  // View from the left: depth grows along +R, columns along -A, rows along -S, 1.5 mm per pixel.
  // The camera is at the center of the 48 x 40 pixels.
  std::size_t inside = 0;
  for (const auto& [x, y, z, depth] : readPly(folder / "a.ply").vertices) {
    EXPECT_NEAR(x, position[0] + depth, 1e-3);
    const double column = (position[1] - y) / 1.5 + 23.5, row = (position[2] - z) / 1.5 + 19.5;
    if (column < -0.1 || column > 47.1 || row < -0.1 || row > 39.1)
      continue;
    ++inside;
    const auto pixel = static_cast<std::size_t>(std::lround(row) * 48 + std::lround(column));
    EXPECT_NEAR(column, std::round(column), 1e-3);
    EXPECT_NEAR(row, std::round(row), 1e-3);
    EXPECT_NEAR(clip[pixel], depth, 1e-3);
  }
  EXPECT_GT(inside, 50u);
}

INSTANTIATE_TEST_SUITE_P(Clips, SurfaceCommand, ::testing::Values("surface", "cutaway"),
                         [](const auto& info) { return std::string(info.param); });

TEST(SurfaceCommandLine, RejectsUnwritableFilesAndRendersWithoutSurface) {
  const TemporaryFolder folder;
  std::filesystem::create_directory_symlink(kneeFolder() / "knee", folder / "knee");
  std::filesystem::create_directory(folder / "folder.vtp");
  const auto surfaceArguments = [](const std::string& file) {
    return makeKneeArguments({"--surface", file});
  };
  const std::string extensions = ": | .vtp, .ply or .stl";
  const std::string unavailable =
      "--surface: not available with --clip none and plane; add --focus";
  expectErrors(
      {
          {"unknown extension", surfaceArguments("a.obj"), 2, "a.obj" + extensions},
          {"no extension", surfaceArguments("a"), 2, "a" + extensions},
          {"no clip", makeKneeArguments({"--surface", "a.vtp", "--clip", "none"}), 2, unavailable},
          {"no focus", {"knee/knee.nrrd", "--surface", "a.vtp"}, 2, unavailable},
          {"a missing folder", surfaceArguments("missing/a.vtp"), 4,
           "missing/a.vtp: cannot be written: "},
          {"no permission", surfaceArguments("/proc/a.ply"), 4, "/proc/a.ply: cannot be written: "},
          {"a folder", surfaceArguments("folder.vtp"), 4, "folder.vtp:"},
          {"over the stats", makeKneeArguments({"--surface", "a.vtp", "--stats-json", "./a.vtp"}),
           2, "a.vtp:"},
          {"over a missing input",
           {"knee/knee.nrrd", "--segmentation", "knee/bone.vtp", "--focus", "1", "--surface",
            "knee/bone.vtp"},
           3,
           "knee/bone.vtp:"},
          {"twice", makeKneeArguments({"--surface", "a.vtp", "--surface", "b.vtp"}), 2,
           "--surface:"},
      },
      folder.path());
}

} // namespace
} // namespace fenestra::core::SurfaceCommandTests
