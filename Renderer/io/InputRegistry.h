#pragma once
// Ledger of every file that the process reads: no result may replace such a file, under any name.
// Every reader calls requireFile before it opens a file.

#include <compare>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace fenestra {

/// Identity of a file, equal for all its names and links. `born` distinguishes a later file that
/// reuses the inode number.
struct FileId {
  std::uint64_t device = 0, inode = 0;
  std::int64_t birthTime = 0; ///< birth, ns since 1970; 0: not reported by the disk

  friend auto operator<=>(const FileId&, const FileId&) = default;
};

/// Identity of the file behind `path`; links are followed. nullopt: no such file.
std::optional<FileId> fileId(const std::filesystem::path& path);
/// Identity of an open file.
std::optional<FileId> fileId(int descriptor);

/// True if a file or folder is at `path`; isFolder: if a folder is. Links are followed. Throws
/// Error (input) where the system cannot say.
bool fileExists(const std::filesystem::path& path);
bool isFolder(const std::filesystem::path& path);

/// Enters `path` into the ledger. Throws Error (input) unless `path` is a readable file of at most
/// `most` bytes, inside the folder of InputConfinement if one is set, and no result of this
/// process. `mend`: advice in the message for a folder.
void requireFile(const std::filesystem::path& path, const std::string& hint,
                 std::uint64_t maxBytes = UINT64_MAX);

/// Enters the file at `path`, or the files directly in the folder at `path`, into the ledger. No
/// effect where neither exists. For files that are read later, or that belong to a file that is
/// read.
void registerInput(const std::filesystem::path& path);

/// Confines this thread's reads to `folder` during the object's life, whatever the files in
/// `folder` name. For unpacked archives. nullopt: reads anywhere, for a file that the user names
/// while an archive is read.
class InputConfinement {
public:
  explicit InputConfinement(const std::optional<std::filesystem::path>& folder);
  ~InputConfinement();
  InputConfinement(const InputConfinement&) = delete;
  InputConfinement& operator=(const InputConfinement&) = delete;

private:
  std::optional<std::filesystem::path> m_folder;
  const std::filesystem::path* m_before;
};

/// Name under which `file` was first read; nullopt: not in the ledger.
std::optional<std::filesystem::path> findInput(const FileId& file);

/// Removes a file from the ledger: a file that this process has just made (the earlier owner of its
/// inode number is gone), or that is read only to be written again.
void forgetInput(const FileId& file);

/// Registers the result in place at `path`: requireFile refuses that file until unregisterResult.
void registerResult(const std::filesystem::path& path);
void unregisterResult(const std::filesystem::path& path);

/// The last extension with its dot, in lower case: ".GZ" of "a.nii.GZ" is ".gz".
std::string lowercaseExtension(const std::filesystem::path& path);

} // namespace fenestra
