#pragma once
// Locks between processes (flock), released when their process ends in any way. On a disk without
// locks every caller proceeds.

#include "base/safe/Leftovers.h"

#include <filesystem>
#include <optional>
#include <set>
#include <vector>

namespace fenestra {

/// Keeps other runs from placing results in the same folders, so that results of two runs do not
/// mix. Placing takes milliseconds: after 2 s of waiting the caller proceeds without the lock.
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

/// Lock on a result's name, held by one process at a time, for results that take long to write.
/// Locks a temporary file beside the result, which is removed with this object, or after SIGKILL by
/// the next run in the folder.
class NameLock {
public:
  /// Takes the lock unless another process holds the lock. Throws Error (output) where no file can
  /// be made in the folder of `path`.
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
