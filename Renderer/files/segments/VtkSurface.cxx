#include "files/segments/VtkSurface.h"

#include "base/Error.h"
#include "files/formats/VtkArrays.h"
#include "io/InputRegistry.h"

#include <pugixml.hpp>

#include <algorithm>
#include <bit>
#include <cstring>
#include <string_view>

namespace fenestra::core {
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

/// Encoding of the file's arrays, and the memory budget for decoding them.
struct ArrayEncoding {
  MemoryBudget& budget;
  VtkEncoding stored;
};

std::string readBinary(const pugi::xml_node& array, const ArrayEncoding& encoding) {
  constexpr std::size_t chunk = 1 << 20; // the declared size may be far too large
  VtkArrayReader reader(openInlineBytes(array), encoding.stored);
  if (reader.size() > encoding.budget.bytes)
    throw largeSurface;
  const auto size = static_cast<std::size_t>(reader.size());
  std::string bytes;
  while (bytes.size() < size) {
    const std::size_t before = bytes.size();
    bytes.resize(std::min(size, before + chunk));
    reader.read(&bytes[before], bytes.size() - before);
  }
  return bytes;
}

// ---- arrays

template <typename T>
std::vector<double> convertNumbers(const std::string& bytes, const ArrayEncoding& encoding) {
  charge(encoding.budget, bytes.size() / sizeof(T), sizeof(double));
  std::vector<double> numbers(bytes.size() / sizeof(T));
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    T number{};
    std::memcpy(&number, bytes.data() + i * sizeof(T), sizeof(T));
    numbers[i] = static_cast<double>(number);
  }
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
  const auto stored = findVtkEncoding(file);
  if (std::string_view(file.attribute("type").value()) != "PolyData" || !stored ||
      stored->order != std::endian::little)
    throw damagedSurface;
  const ArrayEncoding encoding{budget, *stored};
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
    try {
      return readSurface(document, fieldData, budget);
    } catch (const VtkArrayError&) {
      throw damagedSurface;
    }
  } catch (const SurfaceError& error) {
    throw inputError(error.code, path, error.reason,
                     "; export the segmentation in Slicer as a binary labelmap (.seg.nrrd)");
  }
}

} // namespace fenestra::core
