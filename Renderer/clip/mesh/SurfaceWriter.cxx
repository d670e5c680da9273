#include "clip/mesh/SurfaceWriter.h"

#include "base/Error.h"
#include "base/TextStream.h"
#include "base/safe/Inputs.h"

#include <bit>
#include <map>

namespace fenestra {

namespace {

static_assert(std::endian::native == std::endian::little, "numbers are written as they lie");

/// Appends the bytes of one number or several.
template <typename T>
void append(std::string& bytes, const T& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

void appendFloats(std::string& bytes, const Vec3& v) {
  append(bytes, v.cast<float>());
}

std::string toBase64(const std::string& bytes) {
  constexpr std::string_view digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - at);
    std::uint32_t group = 0;
    for (std::size_t i = 0; i < 3; ++i)
      group = group << 8 | (i < count ? static_cast<unsigned char>(bytes[at + i]) : 0u);
    for (std::size_t i = 0; i < 4; ++i)
      text += i <= count ? digits[group >> (18 - 6 * i) & 0x3f] : '=';
  }
  return text;
}

/// VTK's <DataArray> with inline bytes.
template <typename Item>
std::string dataArray(const char* name, const char* type, int components,
                      const std::vector<Item>& items) {
  std::string bytes;
  append(bytes, std::uint64_t{items.size() * sizeof(Item)});
  for (const Item& item : items)
    append(bytes, item);
  TextWriter text;
  text << "<DataArray type=\"" << type << "\" Name=\"" << name << "\" NumberOfComponents=\""
       << components << "\" format=\"binary\">" << toBase64(bytes) << "</DataArray>\n";
  return text.str();
}

std::string encodeVtp(const SurfaceMesh& surface) {
  std::vector<std::int32_t> ends;
  for (std::size_t i = 1; i <= surface.triangles.size(); ++i)
    ends.push_back(static_cast<std::int32_t>(3 * i));
  TextWriter text;
  text << "<?xml version=\"1.0\"?>\n"
       << "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
       << "header_type=\"UInt64\">\n<PolyData>\n<FieldData>\n"
       << "<Array type=\"String\" Name=\"SPACE\" NumberOfTuples=\"1\" format=\"ascii\">"
       << "82 65 83 0</Array>\n</FieldData>\n"
       << "<Piece NumberOfPoints=\"" << surface.points.size() << "\" NumberOfVerts=\"0\" "
       << "NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"" << surface.triangles.size()
       << "\">\n<PointData Scalars=\"depth\">\n"
       << dataArray("depth", "Float32", 1, surface.depths) << "</PointData>\n<Points>\n"
       << dataArray("Points", "Float64", 3, surface.points) << "</Points>\n<Polys>\n"
       << dataArray("connectivity", "Int32", 1, surface.triangles)
       << dataArray("offsets", "Int32", 1, ends) << "</Polys>\n</Piece>\n</PolyData>\n</VTKFile>\n";
  return text.str();
}

std::string encodePly(const SurfaceMesh& surface) {
  TextWriter header;
  header << "ply\nformat binary_little_endian 1.0\ncomment SPACE=RAS\n"
         << "element vertex " << surface.points.size() << "\nproperty float x\nproperty float y\n"
         << "property float z\nproperty float depth\nelement face " << surface.triangles.size()
         << "\nproperty list uchar int vertex_indices\nend_header\n";
  std::string bytes = header.str();
  for (std::size_t i = 0; i < surface.points.size(); ++i) {
    appendFloats(bytes, surface.points[i]);
    append(bytes, surface.depths[i]);
  }
  for (const auto& triangle : surface.triangles) {
    append(bytes, std::uint8_t{3});
    append(bytes, triangle);
  }
  return bytes;
}

std::string encodeStl(const SurfaceMesh& surface) {
  std::string bytes = "Fenestra clipping surface SPACE=RAS";
  bytes.resize(80, ' ');
  append(bytes, static_cast<std::uint32_t>(surface.triangles.size()));
  for (const auto& [a, b, c] : surface.triangles) {
    const Vec3& corner = surface.points[a];
    appendFloats(bytes,
                 (surface.points[b] - corner).cross(surface.points[c] - corner).normalized());
    for (const std::uint32_t point : {a, b, c})
      appendFloats(bytes, surface.points[point]);
    append(bytes, std::uint16_t{0});
  }
  return bytes;
}

using Encoder = std::string (*)(const SurfaceMesh&);

Encoder encoderFor(const std::filesystem::path& path) {
  static const std::map<std::string, Encoder> encoders = {
      {".vtp", encodeVtp}, {".ply", encodePly}, {".stl", encodeStl}};
  const auto it = encoders.find(lowerExtension(path));
  if (it == encoders.end())
    throw usageError("--surface ", path,
                     ": has no known extension; name a file .vtp, .ply or .stl");
  return it->second;
}

} // namespace

void writeSurface(const SurfaceMesh& surface, const std::filesystem::path& path, Outputs& outputs) {
  outputs.write(path, encoderFor(path)(surface));
}

void declareSurface(const std::filesystem::path& path, Outputs& outputs) {
  encoderFor(path);
  outputs.add(path);
}

} // namespace fenestra
