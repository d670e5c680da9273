#include "clip/mesh/SurfaceWriter.h"

#include "base/Error.h"
#include "io/Base64.h"
#include "io/InputRegistry.h"

#include <bit>
#include <map>

namespace fenestra::core {

namespace {

static_assert(std::endian::native == std::endian::little, "numbers are written in memory order");

/// Appends the bytes of a number or of an array of numbers.
template <typename T>
void append(std::string& bytes, const T& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

void appendFloats(std::string& bytes, const Vec3& v) {
  append(bytes, v.cast<float>());
}

/// VTK's <DataArray> with inline bytes.
template <typename Item>
std::string encodeDataArray(const char* name, const char* type, int components,
                            const std::vector<Item>& items) {
  std::string bytes;
  append(bytes, std::uint64_t{items.size() * sizeof(Item)});
  for (const Item& item : items)
    append(bytes, item);
  return concat("<DataArray type=\"", type, "\" Name=\"", name, "\" NumberOfComponents=\"",
                components, "\" format=\"binary\">", toBase64(bytes), "</DataArray>\n");
}

/// The array SPACE states the coordinate system, as in Slicer's files; "82 65 83 0" is "RAS".
std::string encodeVtp(const SurfaceMesh& surface) {
  std::vector<std::int32_t> ends;
  for (std::size_t i = 1; i <= surface.triangles.size(); ++i)
    ends.push_back(static_cast<std::int32_t>(3 * i));
  const std::string depths = surface.depths.empty()
                                 ? "<PointData>\n"
                                 : "<PointData Scalars=\"depth\">\n" +
                                       encodeDataArray("depth", "Float32", 1, surface.depths);
  return concat("<?xml version=\"1.0\"?>\n",
                "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" ",
                "header_type=\"UInt64\">\n<PolyData>\n<FieldData>\n",
                "<Array type=\"String\" Name=\"SPACE\" NumberOfTuples=\"1\" format=\"ascii\">",
                "82 65 83 0</Array>\n</FieldData>\n", "<Piece NumberOfPoints=\"",
                surface.points.size(), "\" NumberOfVerts=\"0\" ",
                "NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"",
                surface.triangles.size(), "\">\n", depths, "</PointData>\n<Points>\n",
                encodeDataArray("Points", "Float64", 3, surface.points), "</Points>\n<Polys>\n",
                encodeDataArray("connectivity", "Int32", 1, surface.triangles),
                encodeDataArray("offsets", "Int32", 1, ends),
                "</Polys>\n</Piece>\n</PolyData>\n</VTKFile>\n");
}

std::string encodePly(const SurfaceMesh& surface) {
  std::string bytes =
      concat("ply\nformat binary_little_endian 1.0\ncomment SPACE=RAS\n", "element vertex ",
             surface.points.size(), "\nproperty float x\nproperty float y\n", "property float z\n",
             surface.depths.empty() ? "" : "property float depth\n", "element face ",
             surface.triangles.size(), "\nproperty list uchar int vertex_indices\nend_header\n");
  for (std::size_t i = 0; i < surface.points.size(); ++i) {
    appendFloats(bytes, surface.points[i]);
    if (!surface.depths.empty())
      append(bytes, surface.depths[i]);
  }
  for (const auto& triangle : surface.triangles) {
    append(bytes, std::uint8_t{3});
    append(bytes, triangle);
  }
  return bytes;
}

std::string encodeStl(const SurfaceMesh& surface) {
  std::string bytes = "Fenestra surface SPACE=RAS";
  bytes.resize(80, ' '); // STL header
  append(bytes, static_cast<std::uint32_t>(surface.triangles.size()));
  for (const auto& [a, b, c] : surface.triangles) {
    const Vec3& corner = surface.points[a];
    appendFloats(bytes,
                 (surface.points[b] - corner).cross(surface.points[c] - corner).normalized());
    for (const std::uint32_t point : {a, b, c})
      appendFloats(bytes, surface.points[point]);
    append(bytes, std::uint16_t{0}); // attribute byte count
  }
  return bytes;
}

using Encoder = std::string (*)(const SurfaceMesh&);

Encoder findEncoder(const std::filesystem::path& path) {
  static const std::map<std::string, Encoder> encoders = {
      {".vtp", encodeVtp}, {".ply", encodePly}, {".stl", encodeStl}};
  const auto it = encoders.find(lowercaseExtension(path));
  if (it == encoders.end())
    throw requestError(ErrorCode::unsupportedFile, path,
                       "unknown file extension; use .vtp, .ply or .stl");
  return it->second;
}

} // namespace

void writeSurface(const SurfaceMesh& surface, const std::filesystem::path& path, Outputs& outputs) {
  outputs.write(path, findEncoder(path)(surface));
}

void declareSurface(const std::filesystem::path& path, Outputs& outputs) {
  findEncoder(path);
  outputs.add(path);
}

} // namespace fenestra::core
