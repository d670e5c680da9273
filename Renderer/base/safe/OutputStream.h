#pragma once
// A result that is no file: standard output, an open descriptor, a named pipe. For
// base/safe/Outputs.

#include "base/safe/Inputs.h"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace fenestra {

class OutputStream {
public:
  /// /dev/stdout, /dev/stderr, /dev/fd/N, /proc/self/fd/N or a named pipe; empty for other paths.
  /// Throws Error (output) where the descriptor is not open.
  static std::optional<OutputStream> named(const std::filesystem::path& path);

  /// What is behind a descriptor, or the pipe.
  std::optional<FileId> id() const;

  /// Keeps `content` until it is sent.
  void keep(std::string_view content) { m_content = content; }
  /// Writes what was kept, once. Throws Error (output), also where nobody reads a pipe.
  void send();

private:
  OutputStream(std::filesystem::path path, int descriptor)
      : m_path(std::move(path)), m_descriptor(descriptor) {}

  std::filesystem::path m_path;
  int m_descriptor; ///< -1: a named pipe, opened when it is written
  std::string m_content;
};

} // namespace fenestra
