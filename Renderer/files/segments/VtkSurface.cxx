#include "files/segments/VtkSurface.h"

#include "base/Error.h"
#include "io/Base64.h"
#include "io/InputRegistry.h"

#include <pugixml.hpp>
#include <zlib.h>

#include <cstring>
#include <string_view>

namespace fenestra {
namespace {

/// Thrown by the functions below; readVtkSurface adds the file name and a hint.
struct SurfaceError {
  ErrorCode code;
  const char* reason;
};
constexpr SurfaceError damagedSurface{ErrorCode::damagedFile,
                                      "is damaged or not a surface as Slicer writes it"};
constexpr SurfaceError largeSurface{
    ErrorCode::limitExceeded, "needs, with the surfaces before it, more than 1 GiB of memory"};

/// Deducts `count` * `size` bytes from the budget.
void charge(MemoryBudget& budget, std::uint64_t count, std::uint64_t size = 1) {
  if (count > budget.bytes / size)
    throw largeSurface;
  budget.bytes -= count * size;
}

// ---- bytes

std::string decodeBase64(std::string_view text) {
  auto bytes = fromBase64(text);
  if (!bytes)
    throw damagedSurface;
  return *std::move(bytes);
}

template <typename T>
T readNumber(std::string_view bytes, std::uint64_t index) {
  T value{};
  if (bytes.size() / sizeof(T) <= index)
    throw damagedSurface;
  std::memcpy(&value, bytes.data() + index * sizeof(T), sizeof(T));
  return value;
}

/// Encoding of the file's arrays, and the memory budget for decoding them.
struct ArrayEncoding {
  MemoryBudget& budget;
  bool has64BitHeaders = false; ///< header words have 64 bits, not 32
  bool isDeflated = false;

  std::uint64_t header(std::string_view bytes, std::uint64_t index) const {
    return has64BitHeaders ? readNumber<std::uint64_t>(bytes, index)
                           : readNumber<std::uint32_t>(bytes, index);
  }
  std::size_t headerSize() const { return has64BitHeaders ? 8 : 4; }
};

std::string readPlainArray(std::string_view text, const ArrayEncoding& encoding) {
  std::string bytes = decodeBase64(text);
  const std::uint64_t length = encoding.header(bytes, 0);
  bytes.erase(0, encoding.headerSize());
  if (length > bytes.size())
    throw damagedSurface;
  bytes.resize(static_cast<std::size_t>(length));
  return bytes;
}

/// Inflates an array. Its header has the number of blocks, the sizes of a block and of the last one
/// (0: complete), and the deflated size of each block; the blocks follow.
std::string inflateArray(std::string_view text, const ArrayEncoding& encoding) {
  const auto computeBase64Size = [](std::uint64_t bytes) { return (bytes + 2) / 3 * 4; };
  const std::size_t word = encoding.headerSize();
  const std::string start = decodeBase64(text.substr(0, computeBase64Size(3 * word)));
  const std::uint64_t blocks = encoding.header(start, 0);
  if (blocks > text.size())
    throw damagedSurface;
  if (blocks == 0)
    return {};
  const std::uint64_t headerText = computeBase64Size((3 + blocks) * word);
  if (headerText > text.size())
    throw damagedSurface;
  const std::string header = decodeBase64(text.substr(0, static_cast<std::size_t>(headerText)));
  const std::string packed = decodeBase64(text.substr(static_cast<std::size_t>(headerText)));
  const std::uint64_t blockSize = encoding.header(header, 1), lastSize = encoding.header(header, 2);
  std::string bytes;
  std::size_t at = 0;
  if (std::max(blockSize, lastSize) > encoding.budget.bytes / blocks)
    throw largeSurface;
  for (std::uint64_t block = 0; block < blocks; ++block) {
    const std::uint64_t length = encoding.header(header, 3 + block);
    const bool partial = block + 1 == blocks && lastSize != 0;
    const std::uint64_t size = partial ? lastSize : blockSize;
    constexpr std::uint64_t ratio = 1032, slack = 64; // maximum of deflate
    if (length > packed.size() - at || size > length * ratio + slack)
      throw damagedSurface;
    const std::size_t before = bytes.size();
    bytes.resize(before + static_cast<std::size_t>(size));
    auto written = static_cast<uLongf>(size);
    if (uncompress(reinterpret_cast<Bytef*>(bytes.data() + before), &written,
                   reinterpret_cast<const Bytef*>(packed.data() + at),
                   static_cast<uLong>(length)) != Z_OK ||
        written != size)
      throw damagedSurface;
    at += static_cast<std::size_t>(length);
  }
  return bytes;
}

std::string readBinary(const pugi::xml_node& array, const ArrayEncoding& encoding) {
  std::string text = array.text().get();
  std::erase_if(text, [](unsigned char c) { return std::isspace(c); });
  return encoding.isDeflated ? inflateArray(text, encoding) : readPlainArray(text, encoding);
}

// ---- arrays

template <typename T>
std::vector<double> convertNumbers(const std::string& bytes, const ArrayEncoding& encoding) {
  charge(encoding.budget, bytes.size() / sizeof(T), sizeof(double));
  std::vector<double> numbers(bytes.size() / sizeof(T));
  for (std::size_t i = 0; i < numbers.size(); ++i)
    numbers[i] = static_cast<double>(readNumber<T>(bytes, i));
  return numbers;
}

std::vector<double> readNumbers(const pugi::xml_node& array, const ArrayEncoding& encoding) {
  const std::string format = array.attribute("format").value();
  if (format == "ascii") {
    const std::string_view text = array.text().get();
    charge(encoding.budget, text.size() / 2, sizeof(double)); // a number takes 2 characters or more
    auto numbers = parseNumbers(text);
    if (!numbers)
      throw damagedSurface;
    return *std::move(numbers);
  }
  if (format != "binary")
    throw damagedSurface; // "appended", which Slicer does not write
  const std::string bytes = readBinary(array, encoding);
  using Convert = std::vector<double> (*)(const std::string&, const ArrayEncoding&);
  static const std::map<std::string, Convert> known = {
      {"Float32", convertNumbers<float>},      {"Float64", convertNumbers<double>},
      {"Int32", convertNumbers<std::int32_t>}, {"UInt32", convertNumbers<std::uint32_t>},
      {"Int64", convertNumbers<std::int64_t>}, {"UInt64", convertNumbers<std::uint64_t>}};
  const auto convert = known.find(array.attribute("type").value());
  if (convert == known.end())
    throw damagedSurface;
  return convert->second(bytes, encoding);
}

/// First string of an array of strings.
std::string readString(const pugi::xml_node& array, const ArrayEncoding& encoding) {
  std::string text;
  if (std::string_view(array.attribute("format").value()) == "ascii")
    for (const double code : readNumbers(array, encoding))
      text += static_cast<char>(code > -129.0 && code < 256.0 ? static_cast<int>(code) : '?');
  else
    text = readBinary(array, encoding);
  charge(encoding.budget, text.size());
  return text.substr(0, text.find('\0'));
}

// ---- polygons

pugi::xml_node findArray(const pugi::xml_node& parent, const char* name) {
  return parent.find_child_by_attribute("DataArray", "Name", name);
}

/// Adds the triangles of polygons (fans) or strips. `first`: index of the piece's first point.
void addTriangles(const pugi::xml_node& cells, const ArrayEncoding& encoding, bool strips,
                  std::size_t first, VtkSurface& surface) {
  if (!findArray(cells, "offsets"))
    return;
  const auto pointCount = static_cast<double>(surface.points.size() - first);
  std::vector<std::uint32_t> points;
  for (const double corner : readNumbers(findArray(cells, "connectivity"), encoding)) {
    if (!(corner >= 0.0 && corner < pointCount))
      throw damagedSurface;
    points.push_back(static_cast<std::uint32_t>(first + static_cast<std::size_t>(corner)));
  }
  std::size_t begin = 0;
  for (const double offset : readNumbers(findArray(cells, "offsets"), encoding)) {
    if (!(offset >= static_cast<double>(begin) && offset <= static_cast<double>(points.size())))
      throw damagedSurface;
    const auto end = static_cast<std::size_t>(offset);
    if (end > begin + 2)
      charge(encoding.budget, end - begin - 2, sizeof(surface.triangles.front()));
    for (std::size_t i = begin + 2; i < end; ++i)
      surface.triangles.push_back({points[strips ? i - 2 : begin], points[i - 1], points[i]});
    begin = end;
  }
}

void addPiece(const pugi::xml_node& piece, const ArrayEncoding& encoding, VtkSurface& surface) {
  const std::size_t first = surface.points.size();
  if (const auto array = piece.child("Points").child("DataArray")) {
    const std::vector<double> coordinates = readNumbers(array, encoding);
    if (coordinates.size() % 3 != 0 || coordinates.size() > UINT32_MAX)
      throw damagedSurface;
    for (std::size_t i = 0; i < coordinates.size(); i += 3) {
      surface.points.emplace_back(coordinates[i], coordinates[i + 1], coordinates[i + 2]);
      constexpr double largest = 1e9; // mm
      if (!(surface.points.back().array().abs() < largest).all())
        throw damagedSurface;
    }
  }
  addTriangles(piece.child("Polys"), encoding, false, first, surface);
  addTriangles(piece.child("Strips"), encoding, true, first, surface);
  surface.hasLines = surface.hasLines || piece.attribute("NumberOfLines").as_int() > 0;
}

VtkSurface readSurface(const pugi::xml_document& document, const std::set<std::string>& fieldData,
                       MemoryBudget& budget) {
  const pugi::xml_node file = document.child("VTKFile");
  const std::string_view compressor = file.attribute("compressor").value();
  if (std::string_view(file.attribute("type").value()) != "PolyData" ||
      std::string_view(file.attribute("byte_order").value()) != "LittleEndian" ||
      (!compressor.empty() && compressor != "vtkZLibDataCompressor"))
    throw damagedSurface;
  const ArrayEncoding encoding{budget,
                               std::string_view(file.attribute("header_type").value()) == "UInt64",
                               !compressor.empty()};
  VtkSurface surface;
  const pugi::xml_node data = file.child("PolyData");
  for (const pugi::xml_node& array : data.child("FieldData").children()) {
    const std::string name = array.attribute("Name").value();
    if (!fieldData.contains(name))
      continue;
    if (std::string_view(array.name()) == "Array")
      surface.texts[name] = readString(array, encoding);
    else
      surface.numbers[name] = readNumbers(array, encoding);
  }
  for (const pugi::xml_node& piece : data.children("Piece"))
    addPiece(piece, encoding, surface);
  return surface;
}

} // namespace

VtkSurface readVtkSurface(const std::filesystem::path& path, const std::set<std::string>& fieldData,
                          MemoryBudget& budget) {
  requireFile(path, "give a .vtp file in it");
  pugi::xml_document document;
  try {
    charge(budget, std::filesystem::file_size(path));
    if (!document.load_file(path.c_str()))
      throw damagedSurface;
    return readSurface(document, fieldData, budget);
  } catch (const SurfaceError& error) {
    throw inputError(error.code, path, error.reason,
                     "; export the segmentation in Slicer as a binary labelmap (.seg.nrrd)");
  }
}

} // namespace fenestra
