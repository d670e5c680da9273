#include "files/pictures/ExrHeader.h"

#include "base/TextStream.h"

#include <cstdint>
#include <map>
#include <stdexcept>
#include <string>

namespace fenestra {

namespace {

/// Bytes of attribute types of fixed size ("OpenEXR File Layout", openexr.com).
const std::map<std::string, std::uint32_t> fixedSizes = {
    {"box2f", 16},   {"box2i", 16},         {"compression", 1}, {"chromaticities", 32},
    {"double", 8},   {"deepImageState", 1}, {"envmap", 1},      {"float", 4},
    {"int", 4},      {"keycode", 28},       {"lineOrder", 1},   {"m33d", 72},
    {"m33f", 36},    {"m44d", 128},         {"m44f", 64},       {"rational", 8},
    {"tiledesc", 9}, {"timecode", 8},       {"v2d", 16},        {"v2f", 8},
    {"v2i", 8},      {"v3d", 24},           {"v3f", 12},        {"v3i", 12}};

std::uint32_t number(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0; // little endian
  for (std::size_t i = 0; i < 4 && at + i < bytes.size(); ++i)
    value |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[at + i])) << (8 * i);
  return value;
}

/// True for channels (each a name and 16 bytes), then an empty name.
bool isChannelList(const std::string& value) {
  std::size_t at = 0;
  while (at < value.size() && value[at] != '\0') {
    at = value.find('\0', at);
    at = at == std::string::npos ? value.size() : at + 17;
  }
  return at + 1 == value.size();
}

bool isStringVector(const std::string& value) {
  std::uint64_t at = 0;
  while (at + 4 <= value.size())
    at += std::uint64_t{4} + number(value, at);
  return at == value.size();
}

/// True for width, height, and that many pixels of four bytes.
bool isPreview(const std::string& value) {
  const std::uint64_t width = number(value, 0), height = number(value, 4);
  return value.size() >= 8 && width <= value.size() && height <= value.size() &&
         8 + 4 * width * height == value.size();
}

/// True if `value` is one whole value of `type`. Unknown types pass: OpenEXR reads them by their
/// size.
bool fillsItsSize(const std::string& type, const std::string& value) {
  if (const auto fixed = fixedSizes.find(type); fixed != fixedSizes.end())
    return value.size() == fixed->second;
  if (type == "chlist")
    return isChannelList(value);
  if (type == "stringvector")
    return isStringVector(value);
  if (type == "preview")
    return isPreview(value);
  if (type == "floatvector")
    return value.size() % 4 == 0;
  return type != "idmanifest"; // needed by deep pixels alone
}

} // namespace

void checkExrAttributes(const std::filesystem::path& path) {
  Throwing<std::ifstream> file(path, std::ios::binary);
  const auto length = static_cast<std::int64_t>(std::filesystem::file_size(path));
  file.seekg(5); // flags of the version field
  const bool severalParts = (file.get() & 0x10) != 0;
  file.seekg(8);
  std::string name, type, size(4, '\0'), value;
  do { // one header per part, and an empty one after the last
    while (std::getline(file, name, '\0') && !name.empty() && std::getline(file, type, '\0')) {
      file.read(size.data(), 4);
      if (!file || number(size, 0) > length - file.tellg())
        throw std::runtime_error("an attribute reaches past the end");
      value.resize(number(size, 0));
      file.read(value.data(), static_cast<std::streamsize>(value.size()));
      if (!fillsItsSize(type, value))
        throw std::runtime_error("an attribute does not fill its size");
    }
  } while (severalParts && file.peek() > 0);
}

} // namespace fenestra
