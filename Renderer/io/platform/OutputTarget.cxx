#include "io/platform/OutputTarget.h"

#include "base/Error.h"
#include "io/platform/Descriptor.h"
#include "io/platform/SystemErrors.h"

#include <cstdio>
#include <iostream>

#include <fcntl.h>

namespace fenestra::core {
namespace {

namespace fs = std::filesystem;

/// True if this process may not rename over the file: in a sticky folder, such as /tmp, only the
/// owners of the file and of the folder may (rename(2), EPERM).
bool isStickyProtected(const struct stat& file, const fs::path& folder) {
  struct stat status = {};
  const uid_t user = ::geteuid();
  return ::stat(folder.c_str(), &status) == 0 && (status.st_mode & S_ISVTX) != 0 && user != 0 &&
         user != file.st_uid && user != status.st_uid;
}

/// N of /dev/fd/N and similar paths; nullopt: other paths.
std::optional<int> parseDescriptorNumber(const std::string& path) {
  if (path == "/dev/stdout")
    return STDOUT_FILENO;
  if (path == "/dev/stderr")
    return STDERR_FILENO;
  for (const std::string_view folder : {"/dev/fd/", "/proc/self/fd/"}) {
    const auto number =
        path.starts_with(folder) ? parseNumber<int>(path.substr(folder.size())) : std::nullopt;
    if (number && *number >= 0)
      return number;
  }
  return std::nullopt;
}

} // namespace

fs::path resolveTarget(const fs::path& path) {
  constexpr int maxLinks = 40; // Linux's limit
  std::error_code failed;
  fs::path target = fs::absolute(path, failed);
  if (failed)
    throw writeError(path, failed.value());
  for (int links = 0; fs::is_symlink(target, failed) && links < maxLinks; ++links)
    target = target.parent_path() / fs::read_symlink(target);
  const fs::path folder = fs::canonical(target.parent_path(), failed);
  if (failed)
    throw writeError(path, failed.value());
  return folder / target.filename();
}

void requireReplaceable(const fs::path& path, const fs::path& target) {
  struct stat status = {};
  if (!target.has_filename())
    throw outputError(ErrorCode::notAFile, path, "is a folder; name a file");
  if (::lstat(target.c_str(), &status) != 0) {
    if (errno != ENOENT)
      throw writeError(path, errno);
    return;
  }
  if (!S_ISREG(status.st_mode))
    throw outputError(ErrorCode::notAFile, path, "is a folder or a device; name a file");
  if ((status.st_mode & 0222) == 0 || ::faccessat(AT_FDCWD, target.c_str(), W_OK, AT_EACCESS) != 0)
    throw outputError(path, "is write-protected; choose another name, or chmod u+w it");
  if (isStickyProtected(status, target.parent_path()))
    throw outputError(path, "belongs to another user, in a folder where only owners may replace "
                            "files; choose another name or folder");
}

void syncFolder(const fs::path& folder) {
  const Descriptor file(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  // A folder that may be written but not read cannot be synced.
  if (!(file.isOpen() ? ::fsync(*file) == 0 || errno == EINVAL : errno == EACCES))
    throw writeError(folder, errno);
}

std::optional<int> findStream(const fs::path& path) {
  if (const auto number = parseDescriptorNumber(path.lexically_normal().string())) {
    const int flags = ::fcntl(*number, F_GETFL);
    if (flags < 0 || (flags & O_ACCMODE) == O_RDONLY)
      throw outputError(path, "is not open for writing; redirect it, as in 3>FILE");
    return number;
  }
  struct stat status = {};
  const bool isPipe = ::stat(path.c_str(), &status) == 0 && S_ISFIFO(status.st_mode);
  return isPipe ? std::optional(namedPipe) : std::nullopt;
}

void sendContent(int stream, const std::string& content, const fs::path& path) {
  if (stream != namedPipe) {
    std::cout.flush(); // earlier output comes first
    std::fflush(stdout);
    return writeAll(stream, content, path);
  }
  // Without O_NONBLOCK, open would block until a process reads the pipe.
  const Descriptor file(::open(path.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC));
  if (!file.isOpen())
    throw outputError(path, "pipe has no reader; start the reader first");
  ::fcntl(*file, F_SETFL, 0);
  writeAll(*file, content, path);
}

} // namespace fenestra::core
