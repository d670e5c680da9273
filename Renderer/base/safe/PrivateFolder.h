#pragma once
// Temporary folder, readable by this user alone. Removed with the object, by a signal that ends the
// process, or after SIGKILL by a later run.

#include "base/safe/Descriptor.h"
#include "base/safe/Leftovers.h"

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace fenestra {

class PrivateFolder {
public:
  /// Makes a folder in TMPDIR, locked (flock) while in use. Throws Error (output) where TMPDIR
  /// cannot be written.
  PrivateFolder();
  ~PrivateFolder();
  PrivateFolder(const PrivateFolder&) = delete;
  PrivateFolder& operator=(const PrivateFolder&) = delete;

  const std::filesystem::path& path() const { return m_entries.front()->path(); }

  /// Makes an empty file at `relative` (normal, without "..") and the folders above it; returns its
  /// full path. Throws Error (output), also where the file exists.
  std::filesystem::path add(const std::filesystem::path& relative);

private:
  void addFolder(const std::filesystem::path& folder);
  bool makeLocked(const std::filesystem::path& folder);

  Descriptor m_lock;
  std::vector<std::unique_ptr<Leftover>> m_entries; ///< the folder, then its content as made
};

/// Removes the private folders that killed runs of this user have left: no process has them locked.
/// Ignores failures.
void removeAbandonedFolders();

} // namespace fenestra
