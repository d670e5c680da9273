#include "files/segments/VtkSurface.h"

#include "base/Error.h"
#include "base/safe/Base64.h"
#include "base/safe/Inputs.h"

#include <pugixml.hpp>
#include <zlib.h>

#include <cstring>
#include <string_view>

namespace fenestra {
namespace {

/// Thrown by the functions below; readVtkSurface adds the file's name and the mend.
struct RefusedSurface {
  const char* why;
};
constexpr RefusedSurface damagedSurface{"is damaged or no surface as Slicer writes it"};
constexpr RefusedSurface largeSurface{
    "takes, with the surfaces before it, more than 1 GiB of memory"};

void take(SurfaceAllowance& allowance, std::uint64_t count, std::uint64_t size = 1) {
  if (count > allowance.bytes / size)
    throw largeSurface;
  allowance.bytes -= count * size;
}

// ---- bytes

std::string decoded(std::string_view text) {
  auto bytes = fromBase64(text);
  if (!bytes)
    throw damagedSurface;
  return *std::move(bytes);
}

template <typename T>
T numberAt(std::string_view bytes, std::uint64_t index) {
  T value{};
  if (bytes.size() / sizeof(T) <= index)
    throw damagedSurface;
  std::memcpy(&value, bytes.data() + index * sizeof(T), sizeof(T));
  return value;
}

/// Encoding of the file's arrays, and their allowance.
struct Coding {
  SurfaceAllowance& allowance;
  bool wideHeaders = false; ///< 64 bit
  bool deflated = false;

  std::uint64_t header(std::string_view bytes, std::uint64_t index) const {
    return wideHeaders ? numberAt<std::uint64_t>(bytes, index)
                       : numberAt<std::uint32_t>(bytes, index);
  }
  std::size_t headerSize() const { return wideHeaders ? 8 : 4; }
};

std::string plainBytes(std::string_view text, const Coding& coding) {
  std::string bytes = decoded(text);
  const std::uint64_t length = coding.header(bytes, 0);
  bytes.erase(0, coding.headerSize());
  if (length > bytes.size())
    throw damagedSurface;
  bytes.resize(static_cast<std::size_t>(length));
  return bytes;
}

/// Inflates an array: a header (blocks, bytes of a block, of the last one, of each when deflated),
/// then the blocks.
std::string inflatedBytes(std::string_view text, const Coding& coding) {
  const auto encodedSize = [](std::uint64_t bytes) { return (bytes + 2) / 3 * 4; };
  const std::size_t word = coding.headerSize();
  const std::string start = decoded(text.substr(0, encodedSize(3 * word)));
  const std::uint64_t blocks = coding.header(start, 0);
  if (blocks > text.size())
    throw damagedSurface;
  if (blocks == 0)
    return {};
  const std::uint64_t headerText = encodedSize((3 + blocks) * word);
  if (headerText > text.size())
    throw damagedSurface;
  const std::string header = decoded(text.substr(0, static_cast<std::size_t>(headerText)));
  const std::string packed = decoded(text.substr(static_cast<std::size_t>(headerText)));
  const std::uint64_t blockSize = coding.header(header, 1), lastSize = coding.header(header, 2);
  std::string bytes;
  std::size_t at = 0;
  if (std::max(blockSize, lastSize) > coding.allowance.bytes / blocks)
    throw largeSurface;
  for (std::uint64_t block = 0; block < blocks; ++block) {
    const std::uint64_t length = coding.header(header, 3 + block);
    const bool partial = block + 1 == blocks && lastSize != 0;
    const std::uint64_t size = partial ? lastSize : blockSize;
    constexpr std::uint64_t ratio = 1032, slack = 64; // deflate's greatest
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

std::string binary(const pugi::xml_node& array, const Coding& coding) {
  std::string text = array.text().get();
  std::erase_if(text, [](unsigned char c) { return std::isspace(c); });
  return coding.deflated ? inflatedBytes(text, coding) : plainBytes(text, coding);
}

// ---- arrays

template <typename T>
std::vector<double> converted(const std::string& bytes, const Coding& coding) {
  take(coding.allowance, bytes.size() / sizeof(T), sizeof(double));
  std::vector<double> numbers(bytes.size() / sizeof(T));
  for (std::size_t i = 0; i < numbers.size(); ++i)
    numbers[i] = static_cast<double>(numberAt<T>(bytes, i));
  return numbers;
}

std::vector<double> numbersOf(const pugi::xml_node& array, const Coding& coding) {
  const std::string format = array.attribute("format").value();
  if (format == "ascii") {
    const std::string_view text = array.text().get();
    take(coding.allowance, text.size() / 2, sizeof(double)); // at least a digit and a blank each
    auto numbers = parseNumbers(text);
    if (!numbers)
      throw damagedSurface;
    return *std::move(numbers);
  }
  if (format != "binary")
    throw damagedSurface; // "appended", which Slicer does not write
  const std::string bytes = binary(array, coding);
  using Convert = std::vector<double> (*)(const std::string&, const Coding&);
  static const std::map<std::string, Convert> known = {
      {"Float32", converted<float>},      {"Float64", converted<double>},
      {"Int32", converted<std::int32_t>}, {"UInt32", converted<std::uint32_t>},
      {"Int64", converted<std::int64_t>}, {"UInt64", converted<std::uint64_t>}};
  const auto convert = known.find(array.attribute("type").value());
  if (convert == known.end())
    throw damagedSurface;
  return convert->second(bytes, coding);
}

/// First string of an array.
std::string readString(const pugi::xml_node& array, const Coding& coding) {
  std::string text;
  if (std::string_view(array.attribute("format").value()) == "ascii")
    for (const double code : numbersOf(array, coding))
      text += static_cast<char>(code > -129.0 && code < 256.0 ? static_cast<int>(code) : '?');
  else
    text = binary(array, coding);
  take(coding.allowance, text.size());
  return text.substr(0, text.find('\0'));
}

// ---- polygons

pugi::xml_node arrayNamed(const pugi::xml_node& parent, const char* name) {
  return parent.find_child_by_attribute("DataArray", "Name", name);
}

/// Adds the triangles of polygons (fans) or strips, whose points are those from `first` on.
void addTriangles(const pugi::xml_node& cells, const Coding& coding, bool strips, std::size_t first,
                  VtkSurface& surface) {
  if (!arrayNamed(cells, "offsets"))
    return;
  const auto pointCount = static_cast<double>(surface.points.size() - first);
  std::vector<std::uint32_t> points;
  for (const double corner : numbersOf(arrayNamed(cells, "connectivity"), coding)) {
    if (!(corner >= 0.0 && corner < pointCount))
      throw damagedSurface;
    points.push_back(static_cast<std::uint32_t>(first + static_cast<std::size_t>(corner)));
  }
  std::size_t begin = 0;
  for (const double offset : numbersOf(arrayNamed(cells, "offsets"), coding)) {
    if (!(offset >= static_cast<double>(begin) && offset <= static_cast<double>(points.size())))
      throw damagedSurface;
    const auto end = static_cast<std::size_t>(offset);
    if (end > begin + 2)
      take(coding.allowance, end - begin - 2, sizeof(surface.triangles.front()));
    for (std::size_t i = begin + 2; i < end; ++i)
      surface.triangles.push_back({points[strips ? i - 2 : begin], points[i - 1], points[i]});
    begin = end;
  }
}

void addPiece(const pugi::xml_node& piece, const Coding& coding, VtkSurface& surface) {
  const std::size_t first = surface.points.size();
  if (const auto array = piece.child("Points").child("DataArray")) {
    const std::vector<double> coordinates = numbersOf(array, coding);
    if (coordinates.size() % 3 != 0 || coordinates.size() > UINT32_MAX)
      throw damagedSurface;
    for (std::size_t i = 0; i < coordinates.size(); i += 3) {
      surface.points.emplace_back(coordinates[i], coordinates[i + 1], coordinates[i + 2]);
      constexpr double largest = 1e9; // mm
      if (!(surface.points.back().array().abs() < largest).all())
        throw damagedSurface;
    }
  }
  addTriangles(piece.child("Polys"), coding, false, first, surface);
  addTriangles(piece.child("Strips"), coding, true, first, surface);
  surface.hasLines = surface.hasLines || piece.attribute("NumberOfLines").as_int() > 0;
}

VtkSurface surfaceOf(const pugi::xml_document& document, const std::set<std::string>& fieldData,
                     SurfaceAllowance& allowance) {
  const pugi::xml_node file = document.child("VTKFile");
  const std::string_view compressor = file.attribute("compressor").value();
  if (std::string_view(file.attribute("type").value()) != "PolyData" ||
      std::string_view(file.attribute("byte_order").value()) != "LittleEndian" ||
      (!compressor.empty() && compressor != "vtkZLibDataCompressor"))
    throw damagedSurface;
  const Coding coding{allowance,
                      std::string_view(file.attribute("header_type").value()) == "UInt64",
                      !compressor.empty()};
  VtkSurface surface;
  const pugi::xml_node data = file.child("PolyData");
  for (const pugi::xml_node& array : data.child("FieldData").children()) {
    const std::string name = array.attribute("Name").value();
    if (!fieldData.contains(name))
      continue;
    if (std::string_view(array.name()) == "Array")
      surface.texts[name] = readString(array, coding);
    else
      surface.numbers[name] = numbersOf(array, coding);
  }
  for (const pugi::xml_node& piece : data.children("Piece"))
    addPiece(piece, coding, surface);
  return surface;
}

} // namespace

VtkSurface readVtkSurface(const std::filesystem::path& path, const std::set<std::string>& fieldData,
                          SurfaceAllowance& allowance) {
  requireFile(path, "name a .vtp file in it");
  pugi::xml_document document;
  try {
    take(allowance, std::filesystem::file_size(path));
    if (!document.load_file(path.c_str()))
      throw damagedSurface;
    return surfaceOf(document, fieldData, allowance);
  } catch (const RefusedSurface& refused) {
    throw inputError(path, refused.why,
                     "; export the segmentation in Slicer as a binary labelmap (.seg.nrrd)");
  }
}

} // namespace fenestra
