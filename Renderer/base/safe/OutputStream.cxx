#include "base/safe/OutputStream.h"

#include "base/Error.h"
#include "base/safe/SystemCalls.h"

#include <cstdio>
#include <fcntl.h>
#include <iostream>
#include <utility>

namespace fenestra {
namespace {

/// N of /dev/fd/N and similar paths; nullopt: other paths.
std::optional<int> descriptorNumber(const std::string& path) {
  if (path == "/dev/stdout")
    return STDOUT_FILENO;
  if (path == "/dev/stderr")
    return STDERR_FILENO;
  for (const std::string_view folder : {"/dev/fd/", "/proc/self/fd/"}) {
    const auto number =
        path.starts_with(folder) ? parsed<int>(path.substr(folder.size())) : std::nullopt;
    if (number && *number >= 0)
      return number;
  }
  return std::nullopt;
}

} // namespace

std::optional<OutputStream> OutputStream::named(const std::filesystem::path& path) {
  if (const auto number = descriptorNumber(path.lexically_normal().string())) {
    const int flags = ::fcntl(*number, F_GETFL);
    if (flags < 0 || (flags & O_ACCMODE) == O_RDONLY)
      throw outputError(path, "is not open for writing; redirect it, as in 3>FILE");
    return OutputStream(path, *number);
  }
  struct stat status = {};
  if (::stat(path.c_str(), &status) == 0 && S_ISFIFO(status.st_mode))
    return OutputStream(path, -1);
  return std::nullopt;
}

std::optional<FileId> OutputStream::id() const {
  return m_descriptor < 0 ? fileId(m_path) : fileId(m_descriptor);
}

void OutputStream::send() {
  if (m_content.empty())
    return;
  const std::string content = std::exchange(m_content, {});
  if (m_descriptor >= 0) {
    std::cout.flush(); // earlier output comes first
    std::fflush(stdout);
    return writeAll(m_descriptor, content, m_path);
  }
  // Opening without O_NONBLOCK would wait for ever where no process reads the pipe.
  const Descriptor file(::open(m_path.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC));
  if (!file.isOpen())
    throw outputError(m_path, "nobody reads this pipe; start its reader first");
  ::fcntl(*file, F_SETFL, 0);
  writeAll(*file, content, m_path);
}

} // namespace fenestra
