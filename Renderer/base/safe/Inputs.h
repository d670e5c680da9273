#pragma once
// Ledger of every file that the process reads: no result may replace one of them, whatever the
// name. requireFile is the one door to it, and every reader goes through that before it opens a
// file.

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <tuple>

namespace fenestra {

inline constexpr std::uint64_t anySize = std::numeric_limits<std::uint64_t>::max();

/// A file whatever its names: links to it have the same. A number that is free is given to another
/// file, which was born later.
struct FileId {
  std::uint64_t device = 0, inode = 0;
  std::int64_t born = 0; ///< ns since 1970; 0 where the disk does not tell

  friend bool operator==(const FileId& a, const FileId& b) { return a.all() == b.all(); }
  friend bool operator<(const FileId& a, const FileId& b) { return a.all() < b.all(); }

private:
  std::tuple<std::uint64_t, std::uint64_t, std::int64_t> all() const {
    return {device, inode, born};
  }
};

/// Empty where there is nothing of this name. Follows links.
std::optional<FileId> fileId(const std::filesystem::path& path);
/// Of an open file.
std::optional<FileId> fileId(int descriptor);

/// Whether there is anything of this name, or a folder. Follows links. Throws Error (input) where
/// that cannot be told.
bool isThere(const std::filesystem::path& path);
bool isFolder(const std::filesystem::path& path);

/// Enters `path` into the ledger. Throws Error (input) unless it is a file of at most `most` bytes
/// inside the folder that InputsWithin names, and no result of this process; `mend` says what to
/// name instead of a folder.
void requireFile(const std::filesystem::path& path, const std::string& mend,
                 std::uint64_t most = anySize);

/// Enters what is at `path` into the ledger, if anything: a file, or those in a folder. For names
/// of files that are read later, or that belong to what is read.
void expectInput(const std::filesystem::path& path);

/// While it lives, this thread reads nothing outside `folder`, whatever the files in it name: for
/// what came out of an archive.
class InputsWithin {
public:
  explicit InputsWithin(const std::filesystem::path& folder);
  ~InputsWithin();
  InputsWithin(const InputsWithin&) = delete;
  InputsWithin& operator=(const InputsWithin&) = delete;

private:
  std::filesystem::path m_folder;
  const std::filesystem::path* m_before;
};

/// The name under which a file was read; empty where it was not.
std::optional<std::filesystem::path> inputNamed(const FileId& file);

/// Takes a file out of the ledger: one that this process has just made (what had its number before
/// is gone), or that is read only to be written again.
void forgetInput(const FileId& file);

/// A result that was put in place: requireFile refuses it until forgetResult.
void enterResult(const std::filesystem::path& path);
void forgetResult(const std::filesystem::path& path);

/// The last extension with its dot, in lower case: ".GZ" of "a.nii.GZ" is ".gz".
std::string lowerExtension(const std::filesystem::path& path);

} // namespace fenestra
