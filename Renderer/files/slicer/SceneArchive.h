#pragma once
// A .mrb: a zip archive with a scene and its files. For sources of files alone.

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>

namespace fenestra {

class SceneArchive {
public:
  /// Throws Error (input) where `path` is no archive, or an entry's name leads out of the archive.
  explicit SceneArchive(const std::filesystem::path& path);
  ~SceneArchive();

  /// Number of each file in the archive, by normal relative path; of several files with one path
  /// the first.
  const std::map<std::filesystem::path, std::uint64_t>& files() const { return m_files; }

  /// Writes one of files() into an existing, empty file. Throws Error: input where the entry is
  /// damaged, encrypted or larger than its packed bytes allow; output where there is no room.
  void extract(const std::filesystem::path& file, const std::filesystem::path& destination) const;
  /// Content of one of files(). Throws Error (input) as extract does, and for more than `most`
  /// bytes.
  std::string text(const std::filesystem::path& file, std::uint64_t most) const;

private:
  struct Zip;

  std::unique_ptr<Zip> m_zip;
  std::map<std::filesystem::path, std::uint64_t> m_files;
};

} // namespace fenestra
