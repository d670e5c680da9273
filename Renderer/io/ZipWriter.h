#pragma once
// Zip archives, byte for byte the same on every run.

#include <filesystem>
#include <string>
#include <variant>
#include <vector>

namespace fenestra {

struct ZipEntry {
  std::string name;                                         ///< in the archive, with slashes
  std::variant<std::filesystem::path, std::string> content; ///< a file's, or this text
};

/// Stores the entries in this order as they are (what is large is compressed already), all dated
/// 1980-01-01. The archive appears whole or not at all. Throws Error (output).
void writeZip(const std::filesystem::path& path, const std::vector<ZipEntry>& entries);

} // namespace fenestra
