#pragma once
// Zip archives, byte for byte the same on every run.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace fenestra {

struct ZipEntry {
  std::string name;         ///< path in the archive, with slashes
  std::string_view content; ///< outlives the entry: a temporary text is refused

  ZipEntry(std::string nameIn, const std::string& contentIn)
      : name(std::move(nameIn)), content(contentIn) {}
  ZipEntry(std::string nameIn, std::string&& contentIn) = delete;
};

/// Archive of the entries in this order, uncompressed (large ones already are), dated 1980-01-01,
/// with `comment` at the end. Throws Error (output), naming `path`, where memory is short.
std::string encodeZip(const std::vector<ZipEntry>& entries, const std::string& comment,
                      const std::filesystem::path& path);

} // namespace fenestra
