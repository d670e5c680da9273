#pragma once
// A file in the memory of several processes, which one of them writes.

#include "io/platform/Descriptor.h"

#include <cstddef>
#include <filesystem>
#include <span>

namespace fenestra::core {

/// Maps a file to read and write. It grows and never shrinks, so that other mappings stay valid.
class MappedFile {
public:
  /// Opens the existing file `path`. Throws Error (output), also unless it is a regular file.
  explicit MappedFile(const std::filesystem::path& path);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  /// Extends the file to at least `size` bytes, which the disk then has; new bytes are 0. The
  /// mapping moves. Throws Error (output), also if the disk is full; the file is then unchanged.
  void extend(std::size_t size);

  /// At least what extend() asked for; multiples of 8 bytes, aligned to 8. Empty before.
  std::span<std::byte> bytes() const { return m_bytes; }

private:
  void unmap();

  std::filesystem::path m_path;
  Descriptor m_file;
  std::span<std::byte> m_bytes;
};

} // namespace fenestra::core
