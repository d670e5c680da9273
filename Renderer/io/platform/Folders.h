#pragma once
// Folders that this process creates. They are removed by the destructor of their object, or when a
// signal ends the process.

#include "io/platform/Descriptor.h"
#include "io/platform/TempFiles.h"

#include <filesystem>
#include <list>

namespace fenestra::core {

/// Creates `folder`, for results, and its missing parents. The destructor removes those that are
/// still empty. Throws Error (output).
class CreatedFolders {
public:
  explicit CreatedFolders(const std::filesystem::path& folder);
  ~CreatedFolders();
  CreatedFolders(const CreatedFolders&) = delete;
  CreatedFolders& operator=(const CreatedFolders&) = delete;

private:
  std::list<TempFileGuard> m_created; ///< the outermost first
};

/// Temporary folder that only this user can read. After SIGKILL a later run removes it.
class PrivateFolder {
public:
  /// Removes stale folders, and creates one in TMPDIR, locked (flock) while in use. Throws Error
  /// (output) if TMPDIR cannot be written to.
  PrivateFolder();
  ~PrivateFolder();
  PrivateFolder(const PrivateFolder&) = delete;
  PrivateFolder& operator=(const PrivateFolder&) = delete;

  const std::filesystem::path& path() const { return m_entries.front().path(); }

  /// Creates an empty file at `relative` (normal, without "..") and its parent folders; returns the
  /// full path. Throws Error (output), also if the file exists.
  std::filesystem::path add(const std::filesystem::path& relative);

private:
  bool makeLocked(const std::filesystem::path& folder);

  Descriptor m_lock;
  std::list<TempFileGuard> m_entries; ///< the folder, then its content in order of creation
};

/// Removes private folders that killed runs of this user have left and no process has locked.
/// Ignores failures.
void removeStaleFolders();

} // namespace fenestra::core
