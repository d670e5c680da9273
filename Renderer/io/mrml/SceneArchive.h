#pragma once
// A .mrb: a zip archive with a scene and its files. For io's own sources.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace fenestra {

class SceneArchive {
public:
  /// Throws Error (input) where it is no archive, or holds names that lead out of it.
  explicit SceneArchive(const std::filesystem::path& path);
  ~SceneArchive();

  /// The files in it, by normal relative path.
  const std::vector<std::filesystem::path>& files() const { return m_files; }
  bool contains(const std::filesystem::path& file) const;

  /// Writes a file of the archive into an existing, empty one. Throws Error: input where the entry
  /// is damaged, encrypted or larger than it can be, output where there is no room.
  void extract(const std::filesystem::path& file, const std::filesystem::path& destination) const;
  /// The same into a string of at most `most` bytes.
  std::string text(const std::filesystem::path& file, std::uint64_t most) const;

private:
  struct Zip;

  std::string m_source;
  std::unique_ptr<Zip> m_zip;
  std::vector<std::filesystem::path> m_files; ///< sorted
  std::vector<std::uint64_t> m_entries;       ///< of each file, its number in the archive
};

} // namespace fenestra
