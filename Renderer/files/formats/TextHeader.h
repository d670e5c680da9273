#pragma once
// Text headers at the start of a file: NRRD and MetaImage.

#include "base/Error.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <system_error>

namespace fenestra::core::header {

inline constexpr std::size_t maxHeaderBytes = 16 << 20;

using Fields = std::map<std::string, std::string>;

/// Value of a field; empty: missing.
inline std::string findValue(const Fields& fields, const std::string& key) {
  const auto found = fields.find(key);
  return found == fields.end() ? std::string() : found->second;
}

inline Error damagedError(const std::filesystem::path& path, const std::string& format) {
  return inputError(ErrorCode::damagedFile, path, "is not a ", format,
                    " file, or its header is damaged; write it again");
}

/// Throws Error (input) if `unit` is a length other than mm: all readers take lengths as mm. Units
/// of other quantities, such as time, are accepted.
inline void checkMillimeters(const std::filesystem::path& path, const std::string& field,
                             const std::string& unit) {
  static const std::set<std::string> others = {
      "m",          "cm",          "dm",         "km",          "um",         "µm",
      "μm",         "nm",          "in",         "ft",          "inch",       "inches",
      "micron",     "microns",     "meter",      "meters",      "metre",      "metres",
      "centimeter", "centimeters", "centimetre", "centimetres", "micrometer", "micrometers",
      "micrometre", "micrometres", "foot",       "feet"};
  if (others.contains(toLower(unit)))
    throw fieldError(path, field, "\"", unit, "\" is not supported; scale the geometry to \"mm\"");
}

/// True if there is a control character other than a tab. Libraries end a line at a zero byte or a
/// lone \r, and would read a different header.
inline bool hasControlCharacter(std::string_view line) {
  return std::any_of(line.begin(), line.end(),
                     [](unsigned char c) { return (c < 0x20 && c != '\t') || c == 0x7f; });
}

/// Reads the text header at the front of a file line by line. Binary samples may follow.
class HeaderLines {
public:
  explicit HeaderLines(const std::filesystem::path& path) : m_file(path, std::ios::binary) {
    std::error_code unknown; // file_size of a pipe fails and returns the largest number
    m_limit = std::min<std::uint64_t>(std::filesystem::file_size(path, unknown), maxHeaderBytes);
    m_text = std::make_unique_for_overwrite<char[]>(m_limit + 1);
  }

  /// Next line, without its line end; valid during the life of this object. nullopt: end of the
  /// file, or a line that goes beyond maxHeaderBytes.
  std::optional<std::string_view> next() {
    char* const begin = m_text.get() + m_position;
    if (!m_file.getline(begin, static_cast<std::streamsize>(m_limit + 1 - m_position)))
      return std::nullopt;
    const auto count = static_cast<std::size_t>(m_file.gcount());
    m_position += count;
    std::string_view line(begin, m_file.eof() ? count : count - 1);
    if (line.ends_with('\r'))
      line.remove_suffix(1);
    return line;
  }

  /// Offset in the file of the byte after the lines read so far.
  std::uint64_t position() const { return m_position; }

private:
  std::ifstream m_file;
  std::unique_ptr<char[]> m_text; ///< all lines read so far
  std::size_t m_limit = 0;        ///< bytes
  std::size_t m_position = 0;
};

} // namespace fenestra::core::header
