#pragma once
// A temporary folder that only this user can read, and that goes away even where a signal ends the
// process.

#include <filesystem>
#include <string_view>

namespace fenestra {

class PrivateFolder {
public:
  /// Where temporary files belong (TMPDIR). Throws Error (output) where that cannot be written.
  PrivateFolder();
  ~PrivateFolder();
  PrivateFolder(const PrivateFolder&) = delete;
  PrivateFolder& operator=(const PrivateFolder&) = delete;

  const std::filesystem::path& path() const { return m_path; }

  /// A new file of this relative, normal path without "..", and the folders it needs. It must not
  /// be there yet. Throws Error (output).
  std::filesystem::path add(const std::filesystem::path& relative);

private:
  void addFolder(const std::filesystem::path& folder);

  std::filesystem::path m_path;
};

/// Removes every PrivateFolder of the process: for a signal handler that ends it (it makes system
/// calls alone).
void removePrivateFolders();

} // namespace fenestra
