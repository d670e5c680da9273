#include "io/medical/NrrdWriter.h"

#include "core/Error.h"
#include "io/AtomicFile.h"

#include <zlib.h>

#include <bit>
#include <fstream>
#include <memory>
#include <sstream>

namespace fenestra {

namespace {

static_assert(std::endian::native == std::endian::little, "voxels are written as they lie");

template <typename Value>
constexpr const char* typeName();
template <>
constexpr const char* typeName<std::uint8_t>() {
  return "unsigned char";
}
template <>
constexpr const char* typeName<std::int16_t>() {
  return "short";
}

/// "(x,y,z)" in LPS, whose first two axes are RAS turned round; "+ 0.0" for no "-0" in the header.
std::string lpsText(const Vec3& ras) {
  std::ostringstream text;
  text.precision(17);
  text << '(' << -ras.x() + 0.0 << ',' << -ras.y() + 0.0 << ',' << ras.z() << ')';
  return text.str();
}

std::string headerText(const Grid& grid, std::size_t layerCount, const std::string& type,
                       const NrrdFields& fields) {
  const bool list = layerCount > 1;
  const auto axes = grid.indexToWorld.linear();
  std::ostringstream text;
  text << "NRRD0004\n"
       << "# Complete NRRD file format specification at:\n"
       << "# http://teem.sourceforge.net/nrrd/format.html\n"
       << "type: " << type << "\ndimension: " << (list ? 4 : 3)
       << "\nspace: left-posterior-superior\nsizes:";
  if (list)
    text << ' ' << layerCount;
  text << ' ' << grid.size.x() << ' ' << grid.size.y() << ' ' << grid.size.z()
       << "\nspace directions:" << (list ? " none" : "");
  for (int axis = 0; axis < 3; ++axis)
    text << ' ' << lpsText(axes.col(axis));
  text << "\nkinds:" << (list ? " list" : "") << " domain domain domain\nendian: little\n"
       << "encoding: gzip\nspace origin: " << lpsText(grid.indexToWorld.translation()) << '\n';
  for (const auto& [key, value] : fields)
    text << key << ":=" << value << '\n';
  text << '\n';
  return text.str();
}

struct CloseGzip {
  void operator()(gzFile_s* file) const { gzclose(file); }
};
using Gzip = std::unique_ptr<gzFile_s, CloseGzip>;

/// Row by row: voxels of several layers are interleaved on the way.
template <typename Value>
bool writeVoxels(gzFile file, const Grid& grid, const std::vector<std::span<const Value>>& layers) {
  const auto rowLength = static_cast<std::size_t>(grid.size.x());
  const auto rows = static_cast<std::size_t>(grid.size.y() * grid.size.z());
  std::vector<Value> row(rowLength * layers.size());
  const auto bytes = static_cast<unsigned>(row.size() * sizeof(Value));
  for (std::size_t r = 0; r < rows; ++r) {
    for (std::size_t layer = 0; layer < layers.size(); ++layer)
      for (std::size_t i = 0; i < rowLength; ++i)
        row[i * layers.size() + layer] = layers[layer][r * rowLength + i];
    if (gzwrite(file, row.data(), bytes) != static_cast<int>(bytes))
      return false;
  }
  return true;
}

} // namespace

template <typename Value>
void writeNrrd(const std::filesystem::path& path, const Grid& grid,
               const std::vector<std::span<const Value>>& layers, const NrrdFields& fields) {
  AtomicFile file(path);
  const std::string temporary = file.temporaryPath().string();
  bool whole = false;
  {
    std::ofstream header(temporary, std::ios::binary);
    header << headerText(grid, layers.size(), typeName<Value>(), fields);
    header.close();
    whole = header.good();
  }
  Gzip gzip(whole ? gzopen(temporary.c_str(), "ab6") : nullptr); // appends: a stream of its own
  whole = gzip && writeVoxels(gzip.get(), grid, layers);
  if (gzip && gzclose(gzip.release()) != Z_OK)
    whole = false;
  if (!whole)
    throw outputError(path.string(), "cannot be written whole; free some space on its disk");
  file.commit();
}

template void writeNrrd(const std::filesystem::path&, const Grid&,
                        const std::vector<std::span<const std::uint8_t>>&, const NrrdFields&);
template void writeNrrd(const std::filesystem::path&, const Grid&,
                        const std::vector<std::span<const std::int16_t>>&, const NrrdFields&);

} // namespace fenestra
