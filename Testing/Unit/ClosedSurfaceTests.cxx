// Closed surfaces of known shapes in every encoding of VTK's arrays, and invalid files.

#include "files/segments/ClosedSurface.h"

#include "Approx.h"
#include "MedicalFiles.h"
#include "model/masks/Voxelize.h"

#include <zlib.h>

#include <random>
#include <sstream>

namespace fenestra::core::ClosedSurfaceTests {
namespace {

using Path = std::filesystem::path;
using Triangles = std::vector<std::array<std::uint32_t, 3>>;

struct Shape {
  std::vector<Vec3> points;
  Triangles triangles;
};

Shape makeBox(const Vec3& lower, const Vec3& upper) {
  Shape shape;
  for (int i = 0; i < 8; ++i)
    shape.points.push_back(Box{lower, upper}.corner(i));
  shape.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                     {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return shape;
}

/// Subdivided octahedron with its points projected onto the sphere.
Shape makeSphere(const Vec3& center, double radius, int divisions) {
  Shape shape{
      {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ(), -Vec3::UnitX(), -Vec3::UnitY(), -Vec3::UnitZ()},
      {{0, 1, 2}, {1, 3, 2}, {3, 4, 2}, {4, 0, 2}, {1, 0, 5}, {3, 1, 5}, {4, 3, 5}, {0, 4, 5}}};
  for (int i = 0; i < divisions; ++i) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> midpoints;
    const auto midpoint = [&](std::uint32_t a, std::uint32_t b) {
      const auto [it, added] = midpoints.try_emplace(std::minmax(a, b), shape.points.size());
      if (added)
        shape.points.push_back((shape.points[a] + shape.points[b]).normalized());
      return it->second;
    };
    Triangles finer;
    for (const auto& [a, b, c] : shape.triangles) {
      const auto ab = midpoint(a, b), bc = midpoint(b, c), ca = midpoint(c, a);
      for (const auto& triangle : Triangles{{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}})
        finer.push_back(triangle);
    }
    shape.triangles = finer;
  }
  for (Vec3& point : shape.points)
    point = center + radius * point;
  return shape;
}

// ---- files
// --------------------------------------------------------------------------------------

std::string encodeBase64(const std::string& bytes) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    unsigned group = 0;
    for (std::size_t i = 0; i < 3; ++i)
      group = group << 8 | (at + i < bytes.size() ? static_cast<unsigned char>(bytes[at + i]) : 0);
    for (std::size_t i = 0; i < 4; ++i)
      text += at + i > bytes.size() ? '=' : digits[group >> (18 - 6 * i) & 63];
  }
  return text;
}

enum class Encoding { ascii, uncompressed, deflated };

/// Text between an array's tags. Compressed blocks are small, so that there are several.
template <typename T>
std::string encodeArray(const std::vector<T>& values, Encoding encoding) {
  std::ostringstream text;
  text.precision(17);
  if (encoding == Encoding::ascii) {
    for (const T value : values)
      text << +value << ' ';
    return text.str();
  }
  const std::string bytes = rawBytes(values);
  if (encoding == Encoding::uncompressed)
    return encodeBase64(rawBytes(std::vector<std::uint64_t>{bytes.size()}) + bytes);
  constexpr std::size_t block = 40;
  std::vector<std::uint64_t> header = {(bytes.size() + block - 1) / block, block,
                                       bytes.size() % block};
  std::string packed;
  for (std::size_t at = 0; at < bytes.size(); at += block) {
    const std::string part = bytes.substr(at, block);
    std::string deflated(compressBound(part.size()), '\0');
    uLongf size = deflated.size();
    compress(reinterpret_cast<Bytef*>(deflated.data()), &size,
             reinterpret_cast<const Bytef*>(part.data()), part.size());
    packed += deflated.substr(0, size);
    header.push_back(size);
  }
  return encodeBase64(rawBytes(header)) + encodeBase64(packed);
}

template <typename T>
std::string makeArray(const std::string& type, const std::string& name,
                      const std::vector<T>& values, Encoding encoding) {
  const std::string tag = type == "String" ? "Array" : "DataArray";
  return "<" + tag + " type=\"" + type + "\" Name=\"" + name + "\" format=\"" +
         (encoding == Encoding::ascii ? "ascii" : "binary") + "\">\n  " +
         encodeArray(values, encoding) + "\n</" + tag + ">\n";
}

std::string makeTextArray(const std::string& name, const std::string& text, Encoding encoding) {
  std::vector<signed char> codes(text.begin(), text.end());
  codes.push_back(0);
  return makeArray("String", name, codes, encoding);
}

std::string makeSurfaceXml(const Shape& shape, const std::string& id, const std::string& name,
                           Encoding encoding) {
  std::vector<float> coordinates;
  for (const Vec3& point : shape.points)
    for (const double x : point)
      coordinates.push_back(static_cast<float>(x));
  std::vector<std::int64_t> corners, offsets;
  for (const auto& triangle : shape.triangles) {
    corners.insert(corners.end(), triangle.begin(), triangle.end());
    offsets.push_back(static_cast<std::int64_t>(corners.size()));
  }
  return "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" "
         "byte_order=\"LittleEndian\" header_type=\"UInt64\"" +
         std::string(encoding == Encoding::deflated ? " compressor=\"vtkZLibDataCompressor\""
                                                    : "") +
         ">\n<PolyData>\n<FieldData>\n" +
         makeTextArray("Segmentation_MasterRepresentation", "Closed surface", encoding) +
         makeTextArray("Segment_ID", id, encoding) + makeTextArray("Segment_Name", name, encoding) +
         makeArray("Float64", "Segment_Color", std::vector<double>{0.25, 0.5, 1.0}, encoding) +
         "</FieldData>\n<Piece NumberOfLines=\"0\"><Points>" +
         makeArray("Float32", "Points", coordinates, encoding) + "</Points>\n<Polys>" +
         makeArray("Int64", "connectivity", corners, encoding) +
         makeArray("Int64", "offsets", offsets, encoding) +
         "</Polys>\n</Piece>\n</PolyData>\n</VTKFile>\n";
}

Path writeBlocks(const TemporaryFolder& folder, const std::vector<std::string>& files) {
  std::string text = "<?xml version=\"1.0\"?>\n<VTKFile type=\"vtkMultiBlockDataSet\" "
                     "version=\"1.0\"><vtkMultiBlockDataSet>\n";
  for (const std::string& file : files)
    text += "<DataSet index=\"0\" file=\"" + file + "\"></DataSet>\n";
  std::filesystem::remove(folder / "s.seg.vtm"); // faster than overwriting
  return folder.write("s.seg.vtm", text + "</vtkMultiBlockDataSet></VTKFile>\n");
}

Path writeSegments(const TemporaryFolder& folder, const std::vector<Shape>& shapes,
                   Encoding encoding = Encoding::deflated) {
  std::vector<std::string> files;
  for (const Shape& shape : shapes) {
    const std::string number = std::to_string(files.size());
    files.push_back("s_" + number + ".vtp");
    folder.write(files.back(), makeSurfaceXml(shape, "id" + number, "ségment " + number, encoding));
  }
  return writeBlocks(folder, files);
}

// ---- tests
// --------------------------------------------------------------------------------------

Grid makeVolumeGrid() {
  Affine map = Affine::Identity();
  map.linear() =
      makeRotation(0.5, Vec3(1, 1, 2).normalized()).linear() * Mat3::Diagonal({0.5, 0.75, 1.0});
  map.translation() = Vec3(-20, 5, 3);
  return {Size3(40, 32, 24), map};
}

TEST(ClosedSurface, EveryEncodingMarksTheVoxelsInside) {
  const TemporaryFolder folder;
  const Grid grid = makeVolumeGrid();
  const Vec3 center = grid.worldCenter() + Vec3(0.3, -0.2, 0.1);
  constexpr double radius = 6.0;
  for (const Encoding encoding : {Encoding::ascii, Encoding::uncompressed, Encoding::deflated}) {
    const Path path = writeSegments(folder, {makeSphere(center, radius, 5)}, encoding);
    const Segmentation segmentation = readSegmentation(path, &grid);
    ASSERT_EQ(segmentation.segments().size(), 1u);
    EXPECT_EQ(segmentation.segments()[0].id, "id0");
    EXPECT_EQ(segmentation.segments()[0].name, "ségment 0");
    EXPECT_TRUE(isApprox(segmentation.segments()[0].color, Rgb(0.25, 0.5, 1.0)));
    const Mask mask = segmentation.makeFocusMask({"ségment 0"}, grid);
    std::int64_t inside = 0, near = 0;
    for (int z = 0; z < grid.size.z(); ++z)
      for (int y = 0; y < grid.size.y(); ++y)
        for (int x = 0; x < grid.size.x(); ++x) {
          const double distance = (grid.indexToWorld * Vec3(x, y, z) - center).norm();
          inside += distance < radius - 0.01; // facets lie inside the sphere
          near += std::abs(distance - radius) <= 0.01;
        }
    EXPECT_GT(inside, 2000);
    EXPECT_GE(mask.count, inside);
    EXPECT_LE(mask.count, inside + near);
    const Vec3 middle = mask.grid.worldToIndex * center;
    const Size3 at = middle.array().round().cast<std::int64_t>();
    EXPECT_EQ(mask.voxels[static_cast<std::size_t>(
                  at.x() + mask.grid.size.x() * (at.y() + mask.grid.size.y() * at.z()))],
              1);
  }
}

TEST(ClosedSurface, OverlappingSegmentsGetLayers) {
  const TemporaryFolder folder;
  const Grid grid(Size3(20, 20, 20), Affine::Identity());
  const Path path = writeSegments(folder, {makeBox(Vec3(1.5, 1.5, 1.5), Vec3(9.5, 9.5, 9.5)),
                                           makeBox(Vec3(5.5, 5.5, 5.5), Vec3(12.5, 12.5, 12.5)),
                                           makeBox(Vec3(14.5, 1.5, 1.5), Vec3(16.5, 3.5, 3.5)),
                                           {}});
  const Segmentation segmentation = readSegmentation(path, &grid);
  const auto& segments = segmentation.segments();
  EXPECT_EQ(segments[0].layer, 0u);
  EXPECT_EQ(segments[1].layer, 1u);
  EXPECT_EQ(segments[2].layer, 0u);
  EXPECT_EQ(segmentation.makeFocusMask({"id0"}, grid).count, 8 * 8 * 8);
  EXPECT_EQ(segmentation.makeFocusMask({"id1"}, grid).count, 7 * 7 * 7);
  EXPECT_EQ(segmentation.makeFocusMask({"id2"}, grid).count, 2 * 2 * 2);
  EXPECT_EQ(segmentation.makeFocusMask({"id0", "id1"}, grid).count, 512 + 343 - 64);
  EXPECT_THROW(segmentation.makeFocusMask({"id3"}, grid), Error);
}

/// The surface is clipped to the volume; the focus continues across the volume's faces.
TEST(ClosedSurface, SurfaceIsClippedToTheVolume) {
  const TemporaryFolder folder;
  const Grid grid(Size3(10, 10, 10), Affine::Identity());
  const Path path = writeSegments(folder, {makeBox(Vec3(-50, 2.5, 2.5), Vec3(50, 4.5, 4.5))});
  EXPECT_EQ(readSegmentation(path, &grid).makeFocusMask({"id0"}, grid).count, 10 * 2 * 2);
  const Path outside = writeSegments(folder, {makeBox(Vec3(50, 50, 50), Vec3(60, 60, 60))});
  fenestra::core::expectRefused(outside, "empty-focus", [&] {
    readSegmentation(outside, &grid).makeFocusMask({"id0"}, grid);
  });
}

TEST(ClosedSurface, WithoutAVolumeGetsItsOwnGrid) {
  const TemporaryFolder folder;
  const Path path = writeSegments(folder, {makeBox(Vec3(-10, 0, 5), Vec3(118, 64, 37))});
  const Segmentation segmentation = readSegmentation(path);
  const Grid& grid = segmentation.grid();
  EXPECT_TRUE(grid.spacing() == Vec3::Constant(0.5));
  const auto count = static_cast<double>(segmentation.makeFocusMask({"id0"}, grid).count);
  EXPECT_NEAR(count / 8.0, 128.0 * 64 * 32, 0.03 * 128 * 64 * 32);
}

/// Rows through edges and corners count each crossing once.
TEST(ClosedSurface, CrossingsAtEdgesCountOnce) {
  const Shape onPlanes = makeBox(Vec3(2, 2, 2), Vec3(6, 6, 6));
  const auto runs = voxelizeSurface(onPlanes.points, onPlanes.triangles, Size3(10, 10, 10));
  ASSERT_TRUE(runs);
  EXPECT_EQ(runs->size(), 16u); // in y and z, the last of five planes is outside
  std::mt19937 random(3);
  for (int i = 0; i < 50; ++i) {
    Shape shape = makeSphere(Vec3(8, 8, 8), 5, 3);
    for (Vec3& point : shape.points) // corners on rows, flat triangles, reversed triangles
      point = (point * (i % 2 ? 1.0 : 2.0)).array().round() / (i % 2 ? 1.0 : 2.0) +
              (i % 5 == 0 ? static_cast<double>(random() % 3) : 0.0);
    EXPECT_TRUE(voxelizeSurface(shape.points, shape.triangles, Size3(20, 20, 20))) << i;
  }
}

void expectRefused(const Path& subject, const Path& path, const std::string& text) {
  fenestra::core::expectRefused(subject, text, [&] { readSegmentation(path); });
}

TEST(ClosedSurface, RejectsOpenSurfaces) {
  const TemporaryFolder folder;
  Shape open = makeBox(Vec3(0, 0, 0), Vec3(5, 5, 5));
  open.triangles.pop_back();
  const Path path = writeSegments(folder, {open});
  expectRefused(path, path, "invalid-file | \"ségment 0\"");
  const Path empty = writeSegments(folder, {{}});
  expectRefused(empty, empty, "invalid-file");
  std::string lines = makeSurfaceXml({}, "a", "b", Encoding::ascii);
  const std::string none = "NumberOfLines=\"0\"";
  lines.replace(lines.find(none), none.size(), "NumberOfLines=\"4\"");
  folder.write("lines.vtp", lines);
  expectRefused(folder / "lines.vtp", writeBlocks(folder, {"lines.vtp"}),
                "invalid-field: Segmentation_MasterRepresentation");
}

TEST(ClosedSurface, RejectsFilesOutsideItsFolder) {
  const TemporaryFolder folder;
  for (const char* name : {"../other.vtp", "a/../../other.vtp", "/etc/passwd", ""}) {
    const Path path = writeBlocks(folder, {name});
    expectRefused(path, path, "invalid-field: DataSet");
  }
  const Path path = writeBlocks(folder, {"absent.vtp"});
  expectRefused(folder / "absent.vtp", path, "missing-file");
}

TEST(ClosedSurface, DamagedBytesAreReadOrRejected) {
  const TemporaryFolder folder;
  const Grid grid(Size3(12, 12, 12), Affine::Identity());
  std::mt19937 random(5);
  int readCount = 0;
  ::testing::internal::CaptureStderr();
  for (const Encoding encoding : {Encoding::ascii, Encoding::uncompressed, Encoding::deflated}) {
    const std::string original =
        makeSurfaceXml(makeSphere(Vec3(0, 0, 0), 5, 1), "id", "name", encoding);
    for (int i = 0; i < 700; ++i) {
      std::string bytes = original;
      if (i % 8 == 0)
        bytes.resize(random() % original.size());
      for (int n = 0; n < 1 + i % 3 && !bytes.empty(); ++n)
        bytes[random() % bytes.size()] = static_cast<char>(random());
      const std::string name = std::to_string(static_cast<int>(encoding) * 1000 + i) + ".vtp";
      folder.write(name, bytes);
      try {
        // Most in a small grid, for speed: the surfaces' own has up to 257^3 voxels.
        readSegmentation(writeBlocks(folder, {name}), i % 10 == 0 ? nullptr : &grid);
        ++readCount;
      } catch (const Error& error) {
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
      }
    }
  }
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  EXPECT_GT(readCount, 50);
}

/// Zeros compress well: 200 kB would expand to 1.5 GiB.
TEST(ClosedSurface, RejectsArraysThatExpandBeyondTheLimit) {
  const TemporaryFolder folder;
  constexpr std::uint64_t block = 1 << 20, blocks = 1536;
  const std::string zeros(block, '\0');
  std::string packed(compressBound(block), '\0');
  uLongf size = packed.size();
  compress(reinterpret_cast<Bytef*>(packed.data()), &size,
           reinterpret_cast<const Bytef*>(zeros.data()), block);
  packed.resize(size);
  std::vector<std::uint64_t> header = {blocks, block, 0};
  std::string all;
  for (std::uint64_t i = 0; i < blocks; ++i) {
    header.push_back(size);
    all += packed;
  }
  const std::string bomb = encodeBase64(rawBytes(header)) + encodeBase64(all);
  const std::string original =
      makeSurfaceXml(makeBox(Vec3(0, 0, 0), Vec3(5, 5, 5)), "id", "name", Encoding::deflated);
  const auto replaceArray = [&](const std::string& arrayName) {
    std::string text = original;
    const std::size_t begin = text.find('>', text.find("Name=\"" + arrayName + "\"")) + 1;
    return text.replace(begin, text.find('<', begin) - begin, bomb);
  };
  for (const char* arrayName :
       {"Points", "connectivity", "offsets", "Segment_Name", "Segment_Color"}) {
    folder.write("large.vtp", replaceArray(arrayName));
    expectRefused(folder / "large.vtp", writeBlocks(folder, {"large.vtp"}),
                  "limit-exceeded | 1 GiB");
  }
  folder.write("unused.vtp",
               replaceArray("Segmentation_MasterRepresentation")); // is never decompressed
  EXPECT_EQ(readSegmentation(writeBlocks(folder, {"unused.vtp"})).segments().size(), 1u);
}

/// SlicerRT's examples contain only contours.
TEST(ClosedSurface, RejectsRealContours) {
  const Path folder = Path(FENESTRA_DATA) / "slicer_scenes" / "slicerrt_scenes";
  if (!std::filesystem::exists(folder))
    GTEST_SKIP() << "no real data at " << FENESTRA_DATA;
  for (const std::string name : {"TinyPatientStructureSet", "EclipseProstate_Structures"})
    expectRefused(folder / (name + ".seg") / (name + ".seg_0.vtp"), folder / (name + ".seg.vtm"),
                  "invalid-field: Segmentation_MasterRepresentation");
}

} // namespace
} // namespace fenestra::core::ClosedSurfaceTests
