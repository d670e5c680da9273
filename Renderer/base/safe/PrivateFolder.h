#pragma once
// Temporary folder that only this user can read, and that goes away even where a signal ends the
// process, or where SIGKILL did and another run comes by.

#include "base/safe/Leftovers.h"

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace fenestra {

class PrivateFolder {
public:
  /// Folder in the place for temporary files (TMPDIR), locked (flock) as long as it is in use.
  /// Throws Error (output) where that cannot be written.
  PrivateFolder();
  ~PrivateFolder();
  PrivateFolder(const PrivateFolder&) = delete;
  PrivateFolder& operator=(const PrivateFolder&) = delete;

  const std::filesystem::path& path() const { return m_entries.front()->path(); }

  /// New file of this relative, normal path without "..", and the folders it needs. It must not
  /// be there yet. Throws Error (output).
  std::filesystem::path add(const std::filesystem::path& relative);

private:
  void addFolder(const std::filesystem::path& folder);
  bool makeLocked(const std::filesystem::path& folder);

  std::vector<std::unique_ptr<Leftover>> m_entries; ///< the folder, then what is in it as it came
  int m_lock = -1;
};

/// Removes what runs that were killed have left: private folders of this user that no process has
/// locked. Where that fails they stay.
void removeAbandonedFolders();

} // namespace fenestra
