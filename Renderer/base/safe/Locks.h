#pragma once
// Locks between processes (flock), which end with the process that has them, however it ends. On a
// disk without locks everybody goes on.

#include "base/safe/Leftovers.h"

#include <filesystem>
#include <optional>
#include <set>
#include <vector>

namespace fenestra {

/// Keeps other runs from placing results in the same folders, so that results of two runs do not
/// mix. Placing takes milliseconds: who waited for seconds goes on without a lock.
class FolderLocks {
public:
  /// Folders that cannot be read are left out.
  explicit FolderLocks(const std::set<std::filesystem::path>& folders);
  ~FolderLocks();
  FolderLocks(const FolderLocks&) = delete;
  FolderLocks& operator=(const FolderLocks&) = delete;

private:
  std::vector<int> m_files;
};

/// A name in a folder, which one process has at a time: for whoever writes under that name for
/// long. A file with a temporary name beside it is what is locked; it goes with this object, and
/// the next run in the folder removes what SIGKILL has left of it.
class NameLock {
public:
  /// Takes the lock unless another process has it. Throws Error (output) where no file can be made
  /// in the folder of `path`.
  explicit NameLock(const std::filesystem::path& path);
  ~NameLock();
  NameLock(const NameLock&) = delete;
  NameLock& operator=(const NameLock&) = delete;

  bool isHeld() const { return m_file >= 0; }

private:
  void take(const std::filesystem::path& lock, const std::filesystem::path& path);

  std::optional<Leftover> m_name;
  int m_file = -1;
};

} // namespace fenestra
