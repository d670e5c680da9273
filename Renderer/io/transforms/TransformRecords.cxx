#include "io/transforms/TransformRecords.h"

#include "core/Error.h"
#include "io/NumberText.h"
#include "io/ShownText.h"
#include "io/transforms/TransformMatrix.h"

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <fstream>

namespace fenestra {
namespace {

std::string trimmed(const std::string& text) {
  const char* const blanks = " \t\r\n";
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string::npos)
    return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::vector<double> numbers(const std::filesystem::path& path, const std::string& text) {
  const auto values = parseNumbers(text);
  if (!values || values->size() > mostParameters)
    throwDamagedTransform(path);
  return *values;
}

// ---- MATLAB's level 4 files
// ------------------------------------------------------------------------

/// One matrix: its name and its values, a column.
struct MatlabColumn {
  std::string name;
  std::uint32_t rows = 0;
  bool single = false, swapped = false;
};

template <typename Unsigned>
Unsigned reversed(Unsigned value) {
  auto bytes = std::bit_cast<std::array<unsigned char, sizeof(Unsigned)>>(value);
  std::reverse(bytes.begin(), bytes.end());
  return std::bit_cast<Unsigned>(bytes);
}

/// The next header; false at the end of the file.
bool readHeader(const std::filesystem::path& path, std::istream& file, MatlabColumn& column) {
  std::array<std::uint32_t, 5> header{}; // kind, rows, columns, imaginary part, length of the name
  if (!file.read(reinterpret_cast<char*>(header.data()), sizeof header)) {
    if (file.gcount() == 0)
      return false;
    throwDamagedTransform(path);
  }
  // The kind is the decimal digits M O P T; M is the byte order, which a small number tells, too.
  column.swapped = header[0] > 9999;
  if (column.swapped)
    for (std::uint32_t& value : header)
      value = reversed(value);
  const auto [kind, rows, columns, imaginary, nameLength] = header;
  constexpr std::uint32_t bigEndian = 1, doubles = 0, singles = 1, longestName = 256;
  const std::uint32_t precision = kind / 10 % 10;
  if (kind > 1999 || kind % 10 != 0 || (kind / 1000 == bigEndian) != column.swapped ||
      (precision != doubles && precision != singles) || columns != 1 || imaginary != 0 ||
      nameLength == 0 || nameLength > longestName)
    throwDamagedTransform(path);
  column.single = precision == singles;
  column.rows = rows;
  column.name.resize(nameLength);
  if (!file.read(column.name.data(), nameLength))
    throwDamagedTransform(path);
  column.name.resize(std::strlen(column.name.c_str())); // the length counts its final zero
  return true;
}

std::vector<double> readColumn(const std::filesystem::path& path, std::istream& file,
                               const MatlabColumn& column) {
  if (column.rows > mostParameters)
    throwDamagedTransform(path);
  const auto next = [&]<typename Real, typename Bits>(Real, Bits bits) {
    if (!file.read(reinterpret_cast<char*>(&bits), sizeof bits))
      throwDamagedTransform(path);
    return static_cast<double>(std::bit_cast<Real>(column.swapped ? reversed(bits) : bits));
  };
  std::vector<double> values(column.rows);
  for (double& value : values)
    value = column.single ? next(0.0F, std::uint32_t{}) : next(0.0, std::uint64_t{});
  return values;
}

} // namespace

void throwDamagedTransform(const std::filesystem::path& path) {
  throw inputError(path.string(), "is damaged, truncated or no transform of ITK's; save it again");
}

TransformRecord transformRecord(const std::filesystem::path& path, const std::string& name) {
  const std::string type = name.substr(0, name.find('_'));
  if (!isLinearTransform(type))
    throw inputError(path.string(), "Transform: " + shown(name) +
                                        " is not linear; harden it in Slicer (Data module, Harden "
                                        "transform) and save again");
  if (name != type + "_double_3_3" && name != type + "_float_3_3")
    throw inputError(path.string(), "Transform: " + shown(name) +
                                        " is not a transform of three axes; save one that is");
  return {type, {}, {}};
}

std::vector<TransformRecord> readTransformText(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::vector<TransformRecord> records;
  for (std::string line; std::getline(file, line);) {
    line = trimmed(line);
    if (line.empty() || line[0] == '#')
      continue;
    const std::size_t colon = line.find(':');
    if (colon == std::string::npos)
      throwDamagedTransform(path);
    const std::string key = trimmed(line.substr(0, colon));
    const std::string value = trimmed(line.substr(colon + 1));
    if (key == "Transform") {
      records.push_back(transformRecord(path, value));
    } else if (key == "Parameters" || key == "FixedParameters") {
      if (records.empty())
        throwDamagedTransform(path);
      (key == "Parameters" ? records.back().parameters : records.back().fixed) =
          numbers(path, value);
    } else if (key == "ComponentTransformFile") {
      throw inputError(path.string(), "ComponentTransformFile: further files are not read; save "
                                      "the composite in one file");
    }
    if (records.size() > mostRecords)
      throwDamagedTransform(path);
  }
  return records;
}

std::vector<TransformRecord> readTransformMatlab(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::vector<TransformRecord> records;
  MatlabColumn column;
  while (readHeader(path, file, column)) {
    records.push_back(transformRecord(path, column.name));
    records.back().parameters = readColumn(path, file, column);
    if (!readHeader(path, file, column) || records.size() > mostRecords)
      throwDamagedTransform(path);
    records.back().fixed = readColumn(path, file, column);
  }
  return records;
}

} // namespace fenestra
