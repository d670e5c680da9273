#pragma once
// Identity, kind and permissions of files.

#include <compare>
#include <cstdint>
#include <filesystem>
#include <optional>

namespace fenestra::core {

/// Identity of a file, equal for all its names and links. `birthTime` distinguishes a later file
/// that reuses the inode number.
struct FileId {
  std::uint64_t device = 0, inode = 0;
  std::int64_t birthTime = 0; ///< ns since 1970; 0: not reported by the file system

  friend auto operator<=>(const FileId&, const FileId&) = default;
};

/// Identity of the file at `path`; links are followed. nullopt: no such file.
std::optional<FileId> fileId(const std::filesystem::path& path);
/// Identity of an open file.
std::optional<FileId> fileId(int descriptor);

struct FileStatus {
  int error = 0; ///< error code of the system; not 0: the rest is unknown
  bool isFolder = false, isRegular = false;
  std::uint64_t bytes = 0;
};
/// Status of the file at `path`; links are followed.
FileStatus readFileStatus(const std::filesystem::path& path);

/// Error code for reading the file at `path`; 0: permitted.
int findReadError(const std::filesystem::path& path);

} // namespace fenestra::core
