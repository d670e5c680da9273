#pragma once
// Result that is no file: standard output, an open descriptor, a named pipe. For base/safe/Outputs.

#include "base/safe/Inputs.h"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace fenestra {

class OutputStream {
public:
  /// Stream for /dev/stdout, /dev/stderr, /dev/fd/N, /proc/self/fd/N or a named pipe; nullopt:
  /// other paths. Throws Error (output) where the descriptor is not open for writing.
  static std::optional<OutputStream> named(const std::filesystem::path& path);

  /// Identity of the file behind the descriptor, or of the pipe.
  std::optional<FileId> id() const;

  /// Keeps `content` until it is sent.
  void keep(std::string_view content) { m_content = content; }
  /// Writes the kept content, once. Throws Error (output), also where no process reads the pipe.
  void send();

private:
  OutputStream(std::filesystem::path path, int descriptor)
      : m_path(std::move(path)), m_descriptor(descriptor) {}

  std::filesystem::path m_path;
  int m_descriptor; ///< -1: named pipe, opened by send
  std::string m_content;
};

} // namespace fenestra
