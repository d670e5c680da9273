#include "files/medical/VtkImage.h"

#include "base/Error.h"
#include "files/formats/VtkArrays.h"
#include "files/medical/MedicalHeader.h"

#include <pugixml.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <map>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>

namespace fenestra::core {
namespace {

using Path = std::filesystem::path;

Error makeDamagedVtkError(const Path& path) {
  return inputError(ErrorCode::damagedFile, path,
                    "is damaged, truncated or no VTK image; write it again");
}

/// The elements of a file. Appended data are not part of it.
struct ImageDocument {
  std::string text; ///< into which `xml` points
  pugi::xml_document xml;
  std::uint64_t appended = 0; ///< file offset of the appended data; 0: none
};

constexpr std::string_view appendedTag = "<AppendedData";

/// Reads the text up to appended data, which may be binary; returns the position of their element.
std::size_t readText(const Path& path, std::ifstream& file, std::string& text) {
  constexpr std::size_t chunk = 1 << 20;
  while (file) {
    const std::size_t before = text.size();
    text.resize(before + chunk);
    file.read(&text[before], chunk);
    text.resize(before + static_cast<std::size_t>(file.gcount()));
    if (before == 0 && text.find("<VTKFile") == std::string::npos)
      throw makeDamagedVtkError(path);
    const std::size_t overlap = std::min(before, appendedTag.size());
    if (const auto found = text.find(appendedTag, before - overlap); found != std::string::npos)
      return found;
  }
  return std::string::npos;
}

std::shared_ptr<ImageDocument> readDocument(const Path& path) {
  auto document = std::make_shared<ImageDocument>();
  std::ifstream file(path, std::ios::binary);
  std::string& text = document->text;
  if (const std::size_t element = readText(path, file, text); element != std::string::npos) {
    constexpr std::size_t longestTag = 4096; // with the blanks before the data
    std::string more(longestTag, '\0');
    file.read(more.data(), longestTag);
    text.append(more, 0, static_cast<std::size_t>(file.gcount()));
    const std::size_t close = text.find('>', element), begin = text.find('_', close);
    if (close == std::string::npos || begin == std::string::npos)
      throw makeDamagedVtkError(path);
    document->appended = begin + 1;
    text.replace(close, std::string::npos, "/></VTKFile>");
  }
  if (!document->xml.load_buffer_inplace(text.data(), text.size()))
    throw makeDamagedVtkError(path);
  return document;
}

// ---- geometry

/// Numbers of an attribute. Throws Error (input) unless there are `count`.
std::vector<double> readNumbers(const Path& path, const pugi::xml_node& node, const char* name,
                                std::size_t count) {
  auto numbers = parseNumbers(node.attribute(name).value());
  if (!numbers || numbers->size() != count)
    throw fieldError(path, name, "must be ", count, " numbers; write the file again");
  return *std::move(numbers);
}

/// First and last index of the points along each axis.
std::array<double, 6> readExtent(const Path& path, const pugi::xml_node& node, const char* name) {
  std::array<double, 6> extent{};
  std::ranges::copy(readNumbers(path, node, name, extent.size()), extent.begin());
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (const double first = extent[2 * axis], last = extent[2 * axis + 1];
        std::abs(first) > INT32_MAX || std::abs(last) > INT32_MAX || first != std::trunc(first) ||
        last != std::trunc(last) || last < first)
      throw fieldError(path, name,
                       "must be a first and a last index per axis; write the file again");
  return extent;
}

/// An attribute of three numbers; nullopt: it is missing.
std::optional<Vec3> readVector(const Path& path, const pugi::xml_node& node, const char* name) {
  if (node.attribute(name).empty())
    return std::nullopt;
  const std::vector<double> numbers = readNumbers(path, node, name, 3);
  return Vec3(numbers[0], numbers[1], numbers[2]);
}

Mat3 readDirections(const Path& path, const pugi::xml_node& data) {
  if (data.attribute("Direction").empty())
    return Mat3::Identity();
  const std::vector<double> rows = readNumbers(path, data, "Direction", 9);
  return Mat3(Vec3(rows[0], rows[3], rows[6]), Vec3(rows[1], rows[4], rows[7]),
              Vec3(rows[2], rows[5], rows[8]));
}

/// Sets size and positions of the voxels: the points, or the centers of the cells.
void readGeometry(const Path& path, const pugi::xml_node& data, bool hasCells,
                  const std::optional<Vec3>& chosen, VtkImage& image) {
  const std::array<double, 6> extent = readExtent(path, data, "WholeExtent");
  if (readExtent(path, data.child("Piece"), "Extent") != extent)
    throw fieldError(path, "Extent", "of the piece is not that of the image; write the file again");
  Vec3 first;
  for (int axis = 0; axis < 3; ++axis) {
    const auto at = 2 * static_cast<std::size_t>(axis);
    image.size[axis] = static_cast<std::int64_t>(extent[at + 1] - extent[at]) + (hasCells ? 0 : 1);
    if (image.size[axis] < 1)
      throw fieldError(path, "WholeExtent", "axis ", axis + 1, " has no cells; write it again");
    first[axis] = extent[at] + (hasCells ? 0.5 : 0.0);
  }
  const std::optional<Vec3> stated = readVector(path, data, "Spacing");
  image.hasSpacing = stated.has_value();
  const Vec3 spacing = stated.value_or(chosen.value_or(Vec3::Constant(1.0)));
  const Mat3 steps = readDirections(path, data) * Mat3::Diagonal(spacing);
  image.indexToWorld =
      Affine(steps, readVector(path, data, "Origin").value_or(Vec3::Zero()) + steps * first);
}

// ---- samples

/// The active scalars, else the only array; null: there is none.
pugi::xml_node findScalars(const Path& path, const pugi::xml_node& data) {
  const auto arrays = data.children("DataArray");
  const auto count = std::distance(arrays.begin(), arrays.end());
  const char* const active = data.attribute("Scalars").value();
  if (const auto array = data.find_child_by_attribute("DataArray", "Name", active);
      array && *active != '\0')
    return array;
  if (count > 1)
    throw inputError(ErrorCode::unsupportedFile, path, "has ", count,
                     " arrays and no active scalars; write the file with one of them");
  return count == 1 ? *arrays.begin() : pugi::xml_node();
}

SampleType findType(const Path& path, const pugi::xml_node& array) {
  static const std::map<std::string_view, SampleType> types = {
      {"Int8", std::int8_t()},     {"UInt8", std::uint8_t()},   {"Int16", std::int16_t()},
      {"UInt16", std::uint16_t()}, {"Int32", std::int32_t()},   {"UInt32", std::uint32_t()},
      {"Int64", std::int64_t()},   {"UInt64", std::uint64_t()}, {"Float32", float()},
      {"Float64", double()}};
  const auto type = types.find(array.attribute("type").value());
  if (type == types.end())
    throw fieldError(path, "DataArray", "has an unsupported type; write the file again");
  if (const int components = array.attribute("NumberOfComponents").as_int(1); components != 1)
    throw inputError(ErrorCode::unsupportedFile, path, "has ", components,
                     " components per voxel; convert it to one scalar per voxel");
  return type->second;
}

/// Numbers of an array of format "ascii", converted chunk by chunk.
class TextNumbers {
public:
  explicit TextNumbers(std::string_view text) : m_text(text) {}

  void read(void* to, std::size_t bytes) {
    for (auto* out = static_cast<char*>(to); bytes > 0;) {
      if (m_position == m_numbers.size())
        parseChunk();
      const std::size_t count = std::min(bytes / sizeof(double), m_numbers.size() - m_position);
      std::memcpy(out, &m_numbers[m_position], count * sizeof(double));
      m_position += count;
      out += count * sizeof(double);
      bytes -= count * sizeof(double);
    }
  }

  /// Throws VtkArrayError if numbers are left.
  void finish() const {
    if (m_position < m_numbers.size() || !trim(m_text).empty())
      throw VtkArrayError();
  }

private:
  void parseChunk() {
    constexpr std::size_t chunk = 1 << 16;
    m_text = trim(m_text);
    std::string_view part = m_text.substr(0, chunk);
    if (part.size() < m_text.size()) // ends within a number
      part = part.substr(0, part.find_last_of(" \t\r\n") + 1);
    m_text.remove_prefix(part.size());
    auto numbers = parseNumbers(part);
    if (!numbers || numbers->empty())
      throw VtkArrayError();
    m_numbers = *std::move(numbers);
    m_position = 0;
  }

  std::string_view m_text; ///< not parsed yet
  std::vector<double> m_numbers;
  std::size_t m_position = 0;
};

/// Bytes of an appended array.
VtkBytes openAppendedBytes(const Path& path, const ImageDocument& document,
                           const pugi::xml_node& array) {
  const auto offset = parseNumber<std::uint64_t>(array.attribute("offset").value());
  const std::uint64_t fileBytes = std::filesystem::file_size(path);
  if (document.appended == 0 || !offset || *offset > fileBytes - document.appended)
    throw makeDamagedVtkError(path);
  const std::string_view encoding =
      document.xml.child("VTKFile").child("AppendedData").attribute("encoding").value();
  const auto file = std::make_shared<std::ifstream>(path, std::ios::binary);
  file->seekg(static_cast<std::streamoff>(document.appended + *offset));
  const auto read = [file](char* to, std::size_t bytes) {
    file->read(to, static_cast<std::streamsize>(bytes));
    return static_cast<std::size_t>(file->gcount());
  };
  return {read, fileBytes - document.appended - *offset, encoding == "base64"};
}

/// `document`: kept as long as the source.
SampleSource openSamples(const Path& path, const std::shared_ptr<ImageDocument>& document,
                         const VtkEncoding& encoding, const pugi::xml_node& array,
                         const Size3& size) {
  SampleSource source{.type = findType(path, array)};
  const std::string_view format = array.attribute("format").value();
  const bool isText = format == "ascii";
  StoredSamples stored;
  stored.bytes = std::filesystem::file_size(path);
  stored.isCompressed = !isText && encoding.isDeflated;
  std::uint64_t count = 0;
  if (__builtin_mul_overflow(size[0], size[1], &count) ||
      __builtin_mul_overflow(count, size[2], &count))
    count = UINT64_MAX;
  const std::uint64_t declared = // a number of a text takes at least two characters
      checkDeclaredBytes(path, stored, count, isText ? 1 : bytesPerSample(source.type));
  source.count = static_cast<std::size_t>(count);
  if (isText) {
    const auto numbers = std::make_shared<TextNumbers>(array.text().get());
    source.type = double();
    source.read = [document, numbers](void* to, std::size_t bytes) { numbers->read(to, bytes); };
    source.finish = [numbers] { numbers->finish(); };
    return source;
  }
  if (format != "binary" && format != "appended")
    throw makeDamagedVtkError(path);
  const auto bytes = std::make_shared<VtkArrayReader>(
      format == "binary" ? openInlineBytes(array) : openAppendedBytes(path, *document, array),
      encoding);
  if (bytes->size() != declared)
    throw inputError(ErrorCode::damagedFile, path, "is damaged: its extent has ", declared,
                     " bytes of samples, its array ", bytes->size(), "; write it again");
  source.isSwapped = encoding.order != std::endian::native && bytesPerSample(source.type) > 1;
  source.read = [document, bytes](void* to, std::size_t part) { bytes->read(to, part); };
  return source;
}

} // namespace

VtkImage openVtkImage(const Path& path, const std::optional<Vec3>& spacing) {
  const std::shared_ptr<ImageDocument> document = readDocument(path);
  const pugi::xml_node root = document->xml.child("VTKFile"), data = root.child("ImageData");
  if (!data)
    throw makeDamagedVtkError(path);
  const auto encoding = findVtkEncoding(root);
  if (!encoding)
    throw inputError(ErrorCode::unsupportedFile, path,
                     "has an unknown byte order or compressor; write it with zlib or without "
                     "compression");
  const auto pieces = data.children("Piece");
  if (const auto count = std::distance(pieces.begin(), pieces.end()); count != 1)
    throw inputError(ErrorCode::unsupportedFile, path, "has ", count,
                     " pieces; write the image as one piece");
  const pugi::xml_node piece = data.child("Piece");
  pugi::xml_node array = findScalars(path, piece.child("PointData"));
  const bool hasCells = !array;
  if (hasCells)
    array = findScalars(path, piece.child("CellData"));
  if (!array)
    throw inputError(ErrorCode::unsupportedFile, path,
                     "has no array; write the image with its scalars");
  VtkImage image;
  readGeometry(path, data, hasCells, spacing, image);
  image.samples = openSamples(path, document, *encoding, array, image.size);
  return image;
}

} // namespace fenestra::core
