#pragma once
// Folders for results, made where they are missing.

#include "base/safe/Leftovers.h"

#include <filesystem>
#include <memory>
#include <vector>

namespace fenestra {

/// Makes `folder` and those above it. Those that it made and that nothing was written into go with
/// it. Throws Error (output).
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
