#pragma once
// Results appear whole or not at all: a file is written under a temporary name in its own folder
// and renamed when it is complete.

#include <filesystem>
#include <string_view>

namespace fenestra {

/// A file in the making. Unless committed, it leaves nothing behind and the file that had the name
/// before stays as it was.
class AtomicFile {
public:
  /// Creates the empty temporary file. Throws Error (output) where `path` is something other than a
  /// file, or its folder is missing or not writable.
  explicit AtomicFile(std::filesystem::path path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Write here. The name ends like the real one, for libraries that choose a format by it.
  const std::filesystem::path& temporaryPath() const { return m_temporary; }

  /// Gives the file its name. Throws Error (output).
  void commit();

private:
  std::filesystem::path m_path, m_temporary;
  bool m_committed = false;
};

/// Throws Error (output) where a file of this name could not be created now: for asking before a
/// long render instead of failing after it.
void checkWritable(const std::filesystem::path& path);

/// The whole content of a file, atomically. Throws Error (output), a full disk included.
void writeFile(const std::filesystem::path& path, std::string_view content);

} // namespace fenestra
