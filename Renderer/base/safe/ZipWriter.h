#pragma once
// Zip archives, byte for byte the same on every run.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace fenestra {

struct ZipEntry {
  std::string name; ///< in the archive, with slashes
  std::string_view content;
};

/// Stores the entries in this order as they are (what is large is compressed already), all dated
/// 1980-01-01, and `comment` at the end. Throws Error (output) where memory is short; `path` is
/// named then.
std::string encodeZip(const std::vector<ZipEntry>& entries, const std::string& comment,
                      const std::filesystem::path& path);

} // namespace fenestra
