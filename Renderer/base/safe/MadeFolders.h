#pragma once
// Folders for results, made where they are missing.

#include "base/safe/Leftovers.h"

#include <filesystem>
#include <memory>
#include <vector>

namespace fenestra {

/// Makes `folder` and the missing folders above it. The destructor removes those of them that are
/// still empty. Throws Error (output).
class MadeFolders {
public:
  explicit MadeFolders(const std::filesystem::path& folder);
  ~MadeFolders();
  MadeFolders(const MadeFolders&) = delete;
  MadeFolders& operator=(const MadeFolders&) = delete;

private:
  void make(const std::filesystem::path& folder);

  std::vector<std::unique_ptr<Leftover>> m_made; ///< the outermost first
};

} // namespace fenestra
