#pragma once
// Folders that this process makes, and removes with the object or by a signal that ends the
// process.

#include "io/Descriptor.h"
#include "io/TempFiles.h"

#include <filesystem>
#include <list>

namespace fenestra {

/// Makes `folder`, for results, and the missing folders above it. The destructor removes those of
/// them that are still empty. Throws Error (output).
class CreatedFolders {
public:
  explicit CreatedFolders(const std::filesystem::path& folder);
  ~CreatedFolders();
  CreatedFolders(const CreatedFolders&) = delete;
  CreatedFolders& operator=(const CreatedFolders&) = delete;

private:
  std::list<TempFileGuard> m_created; ///< the outermost first
};

/// Temporary folder, readable by this user alone; removed after SIGKILL by a later run.
class PrivateFolder {
public:
  /// Makes a folder in TMPDIR, locked (flock) while in use. Throws Error (output) where TMPDIR
  /// cannot be written.
  PrivateFolder();
  ~PrivateFolder();
  PrivateFolder(const PrivateFolder&) = delete;
  PrivateFolder& operator=(const PrivateFolder&) = delete;

  const std::filesystem::path& path() const { return m_entries.front().path(); }

  /// Makes an empty file at `relative` (normal, without "..") and the folders above it; returns its
  /// full path. Throws Error (output), also where the file exists.
  std::filesystem::path add(const std::filesystem::path& relative);

private:
  bool makeLocked(const std::filesystem::path& folder);

  Descriptor m_lock;
  std::list<TempFileGuard> m_entries; ///< the folder, then its content as made
};

/// Removes the private folders that killed runs of this user have left: no process has them locked.
/// Ignores failures.
void removeStaleFolders();

} // namespace fenestra
