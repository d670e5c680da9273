#pragma once
// A .mrb: a zip archive with a scene and its files. For io's own sources.

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>

namespace fenestra {

class SceneArchive {
public:
  /// Throws Error (input) where it is no archive, or holds names that lead out of it.
  explicit SceneArchive(const std::filesystem::path& path);
  ~SceneArchive();

  /// The files in it, by normal relative path: of each its number in the archive. Of several with
  /// one path it is the first.
  const std::map<std::filesystem::path, std::uint64_t>& files() const { return m_files; }

  /// Writes one of files() into an existing, empty file. Throws Error: input where the entry is
  /// damaged, encrypted or larger than it can be, output where there is no room.
  void extract(const std::filesystem::path& file, const std::filesystem::path& destination) const;
  /// The same into a string of at most `most` bytes.
  std::string text(const std::filesystem::path& file, std::uint64_t most) const;

private:
  struct Zip;

  std::unique_ptr<Zip> m_zip;
  std::map<std::filesystem::path, std::uint64_t> m_files;
};

} // namespace fenestra
