#pragma once
// Zip archives, with the same bytes on every run.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace fenestra::core {

struct ZipEntry {
  std::string name;         ///< path in the archive, with slashes
  std::string_view content; ///< must outlive the entry: temporaries do not compile

  ZipEntry(std::string nameIn, const std::string& contentIn)
      : name(std::move(nameIn)), content(contentIn) {}
  ZipEntry(std::string nameIn, std::string&& contentIn) = delete;
};

/// Archive of the entries in this order: not compressed (large ones already are), dated 1980-01-01,
/// with `comment` at the end. Throws Error (output), which names `path`, if memory runs out.
std::string encodeZip(const std::vector<ZipEntry>& entries, const std::string& comment,
                      const std::filesystem::path& path);

} // namespace fenestra::core
