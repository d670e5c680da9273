#pragma once
// Locks between processes (flock), released however their process ends. On file systems without
// locks every caller proceeds.

#include "io/platform/Descriptor.h"
#include "io/platform/TempFiles.h"

#include <filesystem>
#include <optional>
#include <set>
#include <vector>

namespace fenestra::core {

/// Locks folders (canonical paths), so that the results that two runs place there do not mix.
/// Placing takes milliseconds: after 2 s of waiting the caller proceeds without the lock. Folders
/// that cannot be read are skipped.
std::vector<Descriptor> lockFolders(const std::set<std::filesystem::path>& folders);

/// Lock on a result's name, held by one process at a time, for results that take long to write.
/// Locks a temporary file beside the result, which is removed with this object or, after SIGKILL,
/// by the next run in the folder.
class NameLock {
public:
  /// Takes the lock unless another process holds it. Throws Error (output) if no file can be
  /// created in the folder of `path`.
  explicit NameLock(const std::filesystem::path& path);

  bool isHeld() const { return m_file.isOpen(); }

private:
  void tryTake(const std::filesystem::path& lock, const std::filesystem::path& path);

  Descriptor m_file;
  std::optional<TempFileGuard> m_name; ///< removed before the lock is released
};

} // namespace fenestra::core
