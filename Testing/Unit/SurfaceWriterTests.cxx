// Surface files, read back with independent code.

#include "base/Error.h"
#include "clip/mesh/SurfaceWriter.h"
#include "files/segments/VtkSurface.h"

#include "ErrorChecks.h"
#include "TemporaryFolder.h"

#include <gtest/gtest.h>
#include <pugixml.hpp>

#include <cstring>
#include <set>

namespace fenestra::core::SurfaceWriterTests {
namespace {

void writeSurface(const SurfaceMesh& surface, const std::filesystem::path& path) {
  Outputs outputs;
  declareSurface(path, outputs);
  writeSurface(surface, path, outputs);
  outputs.commit();
}

/// Mesh of two triangles on four points.
SurfaceMesh makeRoof() {
  SurfaceMesh mesh;
  mesh.points = {{-1.5, 2.0, 100.125}, {3.0, 4.1, -5.0}, {1e-3, 0.0, 7.0}, {1234.5678, 8.0, 9.0}};
  mesh.depths = {10.5f, 11.25f, 0.1f, 300.0f};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

/// Reads values from the start of a file's bytes.
class ByteReader {
public:
  explicit ByteReader(std::string bytes) : m_bytes(std::move(bytes)) {}

  std::string line() {
    const std::size_t end = m_bytes.find('\n', m_at);
    std::string text = m_bytes.substr(m_at, end - m_at);
    m_at = end + 1;
    return text;
  }
  std::string text(std::size_t size) {
    m_at += size;
    return m_bytes.substr(m_at - size, size);
  }
  template <typename T>
  T read() {
    T value{};
    std::memcpy(&value, text(sizeof value).data(), sizeof value);
    return value;
  }
  Vec3 vector() {
    const auto x = read<float>(), y = read<float>(), z = read<float>();
    return {x, y, z};
  }
  std::size_t remaining() const { return m_bytes.size() - m_at; }

private:
  std::string m_bytes;
  std::size_t m_at = 0;
};

/// Decodes base64; drops a partial byte.
std::string decodeBase64(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned bits = 0, count = 0;
  for (const char c : text.substr(0, text.find('='))) {
    bits = bits << 6 | static_cast<unsigned>(digits.find(c));
    count += 6;
    if (count >= 8) {
      count -= 8;
      bytes += static_cast<char>(bits >> count & 0xff);
    }
  }
  return bytes;
}

bool isNear(const Vec3& a, const Vec3& b) {
  return (a - b).norm() <= 1e-6 * b.norm();
}

TEST(SurfaceWriter, VtpHasFullPrecisionAndDepths) {
  const TemporaryFolder folder;
  const SurfaceMesh mesh = makeRoof();
  writeSurface(mesh, folder / "roof.vtp");
  MemoryBudget allowance;
  const VtkSurface readBack = readVtkSurface(folder / "roof.vtp", {"SPACE"}, allowance);
  EXPECT_EQ(readBack.points, mesh.points);
  EXPECT_EQ(readBack.triangles, mesh.triangles);
  EXPECT_EQ(readBack.texts.at("SPACE"), "RAS");

  pugi::xml_document document;
  ASSERT_TRUE(document.load_file((folder / "roof.vtp").c_str()));
  const pugi::xml_node array =
      document.select_node("/VTKFile/PolyData/Piece/PointData/DataArray[@Name='depth']").node();
  EXPECT_STREQ(array.attribute("type").value(), "Float32");
  ByteReader bytes(decodeBase64(array.text().get()));
  EXPECT_EQ(bytes.read<std::uint64_t>(), 16u);
  for (const float depth : mesh.depths)
    EXPECT_EQ(bytes.read<float>(), depth);
  EXPECT_EQ(bytes.remaining(), 0u);
}

TEST(SurfaceWriter, PlyHasDepthsOfItsVertices) {
  const TemporaryFolder folder;
  const SurfaceMesh mesh = makeRoof();
  writeSurface(mesh, folder / "ROOF.PLY");
  ByteReader file(readBytes(folder / "ROOF.PLY"));
  for (const char* line :
       {"ply", "format binary_little_endian 1.0", "comment SPACE=RAS", "element vertex 4",
        "property float x", "property float y", "property float z", "property float depth",
        "element face 2", "property list uchar int vertex_indices", "end_header"})
    EXPECT_EQ(file.line(), line);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_TRUE(isNear(file.vector(), mesh.points[i])) << i;
    EXPECT_EQ(file.read<float>(), mesh.depths[i]);
  }
  for (const auto& triangle : mesh.triangles) {
    EXPECT_EQ(file.read<std::uint8_t>(), 3);
    for (const std::uint32_t point : triangle)
      EXPECT_EQ(file.read<std::uint32_t>(), point);
  }
  EXPECT_EQ(file.remaining(), 0u);
}

TEST(SurfaceWriter, StlHasUnitNormals) {
  const TemporaryFolder folder;
  const SurfaceMesh mesh = makeRoof();
  writeSurface(mesh, folder / "roof.stl");
  ByteReader file(readBytes(folder / "roof.stl"));
  const std::string header = file.text(80);
  EXPECT_FALSE(header.starts_with("solid")) << "which marks a text file";
  EXPECT_NE(header.find("SPACE=RAS"), std::string::npos);
  ASSERT_EQ(file.read<std::uint32_t>(), 2u);
  for (const auto& triangle : mesh.triangles) {
    const Vec3 normal = file.vector();
    std::array<Vec3, 3> corners;
    for (std::size_t i = 0; i < 3; ++i) {
      corners[i] = file.vector();
      EXPECT_TRUE(isNear(corners[i], mesh.points[triangle[i]]));
    }
    const Vec3 expected = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
    EXPECT_LT((normal - expected).norm(), 1e-5);
    EXPECT_EQ(file.read<std::uint16_t>(), 0);
  }
  EXPECT_EQ(file.remaining(), 0u);
}

TEST(SurfaceWriter, IsDeterministicAndWritesEmptySurfaces) {
  const TemporaryFolder folder;
  for (const std::string ending : {".vtp", ".ply", ".stl"}) {
    writeSurface(makeRoof(), folder / ("a" + ending));
    writeSurface(makeRoof(), folder / ("b" + ending));
    EXPECT_EQ(readBytes(folder / ("a" + ending)), readBytes(folder / ("b" + ending)));
    writeSurface({}, folder / ("none" + ending));
    EXPECT_FALSE(readBytes(folder / ("none" + ending)).empty());
  }
  MemoryBudget allowance;
  EXPECT_TRUE(readVtkSurface(folder / "none.vtp", {}, allowance).points.empty());
}

TEST(SurfaceWriter, RefusesUnknownExtensionsAndMissingFolders) {
  const TemporaryFolder folder;
  const auto expectRefusal = [&](const std::string& name, ErrorKind kind,
                                 const std::string& expected) {
    catchError(kind, expected, [&] { writeSurface(makeRoof(), folder / name); });
  };
  expectRefusal("a.obj", ErrorKind::request, "unsupported-file: a.obj");
  expectRefusal("a", ErrorKind::request, "unsupported-file");
  expectRefusal("missing/a.vtp", ErrorKind::output, "unwritable-file: missing/a.vtp");
  Outputs outputs;
  declareSurface(folder / "a.stl", outputs);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

} // namespace
} // namespace fenestra::core::SurfaceWriterTests
