#include "FenestraImage.h"

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <sstream>
#include <system_error>
#include <vector>

namespace SlicerExport {
namespace {

bool isLittleEndian() {
  const std::uint16_t one = 1;
  unsigned char first = 0;
  std::memcpy(&first, &one, 1);
  return first == 1;
}

/// Element of the matrix in LPS, the space of NRRD files; Slicer uses RAS.
double toLps(const Matrix& matrix, std::size_t row, std::size_t column) {
  const double value = matrix[4 * row + column];
  return row < 2 && value != 0.0 ? -value : value;
}

std::string formatPoint(const Matrix& matrix, std::size_t column) {
  std::ostringstream text;
  text.precision(17);
  text << '(' << toLps(matrix, 0, column) << ',' << toLps(matrix, 1, column) << ','
       << toLps(matrix, 2, column) << ')';
  return text.str();
}

std::string makeHeader(const Image& image) {
  const bool list = image.components > 1;
  std::ostringstream text;
  text << "NRRD0005\ntype: " << image.type << "\ndimension: " << (list ? 4 : 3)
       << "\nspace: left-posterior-superior\nsizes:";
  if (list)
    text << ' ' << image.components;
  for (const std::size_t size : image.size)
    text << ' ' << size;
  text << "\nspace directions:" << (list ? " none" : "");
  for (std::size_t axis = 0; axis < 3; ++axis)
    text << ' ' << formatPoint(image.ijkToRas, axis);
  text << "\nkinds:" << (list ? " list" : "")
       << " domain domain domain\nendian: " << (isLittleEndian() ? "little" : "big")
       << "\nencoding: raw\nspace origin: " << formatPoint(image.ijkToRas, 3) << '\n';
  for (const auto& [key, value] : image.fields)
    text << key << ":=" << value << '\n';
  text << '\n';
  return text.str();
}

FileError makeError(const std::filesystem::path& file, const std::string& why) {
  return FileError(file.string() + ": " + why);
}

/// Reads "(a,b,c)", LPS, into a column of a RAS matrix.
void readPoint(const std::string& text, Matrix& matrix, std::size_t column) {
  std::istringstream in(text);
  char separator = 0;
  for (std::size_t row = 0; row < 3; ++row) {
    double value = 0.0;
    if (!(in >> separator >> value))
      throw std::invalid_argument("space origin and space directions need three numbers each");
    matrix[4 * row + column] = row < 2 && value != 0.0 ? -value : value;
  }
}

std::vector<std::string> splitWords(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> all;
  for (std::string word; in >> word;)
    all.push_back(word);
  return all;
}

std::string getField(const std::map<std::string, std::string>& fields, const std::string& name) {
  const auto found = fields.find(name);
  if (found == fields.end())
    throw std::invalid_argument("missing field " + name);
  return found->second;
}

Image parseHeader(const std::map<std::string, std::string>& fields) {
  Image image;
  image.type = getField(fields, "type");
  std::vector<std::string> sizes = splitWords(getField(fields, "sizes"));
  std::vector<std::string> directions = splitWords(getField(fields, "space directions"));
  if (sizes.size() == 4 && directions.size() == 4) {
    image.components = std::stoul(sizes.front());
    sizes.erase(sizes.begin());
    directions.erase(directions.begin());
  }
  if (sizes.size() != 3 || directions.size() != 3)
    throw std::invalid_argument(
        "needs three dimensions, preceded by at most one axis of components");
  for (std::size_t axis = 0; axis < 3; ++axis) {
    image.size[axis] = std::stoul(sizes[axis]);
    readPoint(directions[axis], image.ijkToRas, axis);
  }
  readPoint(getField(fields, "space origin"), image.ijkToRas, 3);
  const bool hasNativeOrder = componentBytes(image.type) == 1 ||
                              getField(fields, "endian") == (isLittleEndian() ? "little" : "big");
  if (getField(fields, "encoding") != "raw" || componentBytes(image.type) == 0 || !hasNativeOrder)
    throw std::invalid_argument("needs raw encoding, a known type and this machine's byte order");
  return image;
}

} // namespace

std::size_t componentBytes(const std::string& type) {
  static const std::map<std::string, std::size_t> sizes = {
      {"int8", 1},   {"uint8", 1},  {"signed char", 1},  {"unsigned char", 1},  {"uchar", 1},
      {"int16", 2},  {"uint16", 2}, {"short", 2},        {"unsigned short", 2}, {"int32", 4},
      {"uint32", 4}, {"int", 4},    {"unsigned int", 4}, {"int64", 8},          {"uint64", 8},
      {"float", 4},  {"double", 8}};
  const auto found = sizes.find(type);
  return found == sizes.end() ? 0 : found->second;
}

std::size_t Image::bytes() const {
  return componentBytes(type) * components * size[0] * size[1] * size[2];
}

FileError makeWriteError(const std::filesystem::path& file) {
  return makeError(file, "cannot be written: " + std::generic_category().message(errno));
}

void writeNrrd(const Image& image, const std::filesystem::path& file) {
  std::filesystem::path partial = file;
  partial += ".part";
  {
    std::ofstream out(partial, std::ios::binary);
    out << makeHeader(image);
    out.write(static_cast<const char*>(image.data.get()),
              static_cast<std::streamsize>(image.bytes()));
    out.close();
    if (!out) {
      const FileError error = makeWriteError(file);
      std::error_code ignored;
      std::filesystem::remove(partial, ignored);
      throw error;
    }
  }
  std::filesystem::rename(partial, file);
}

Image readNrrd(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::string line;
  if (!std::getline(in, line) || line.compare(0, 4, "NRRD") != 0)
    throw makeError(file, "not an NRRD file");
  std::map<std::string, std::string> fields, further;
  while (std::getline(in, line) && !line.empty()) {
    const std::size_t colon = line.find(": "), key = line.find(":=");
    if (line.front() == '#')
      continue;
    if (key < colon)
      further[line.substr(0, key)] = line.substr(key + 2);
    else if (colon != std::string::npos)
      fields[line.substr(0, colon)] = line.substr(colon + 2);
  }
  try {
    Image image = parseHeader(fields);
    image.fields = std::move(further);
    const auto begin = in.tellg();
    const std::uintmax_t rest =
        std::filesystem::file_size(file) - static_cast<std::uintmax_t>(begin);
    if (!in || rest != image.bytes())
      throw std::invalid_argument("data size differs from the header");
    const std::shared_ptr<char[]> data(new char[image.bytes()]);
    if (!in.read(data.get(), static_cast<std::streamsize>(image.bytes())))
      throw std::invalid_argument("data cannot be read");
    image.data = std::shared_ptr<const void>(data, data.get());
    return image;
  } catch (const std::logic_error& error) { // also from std::stoul
    throw makeError(file, error.what());
  }
}

} // namespace SlicerExport
