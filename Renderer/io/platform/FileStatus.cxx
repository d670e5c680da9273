#include "io/platform/FileStatus.h"

#include <cerrno>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace fenestra::core {
namespace {

std::optional<FileId> getFileId(int folder, const char* path, int flags) {
  struct statx status = {};
  if (::statx(folder, path, flags, STATX_INO | STATX_BTIME, &status) != 0)
    return std::nullopt;
  const bool hasBirthTime = (status.stx_mask & STATX_BTIME) != 0;
  return FileId{std::uint64_t{status.stx_dev_major} << 32 | status.stx_dev_minor, status.stx_ino,
                hasBirthTime ? std::int64_t{status.stx_btime.tv_sec} * 1'000'000'000 +
                                   status.stx_btime.tv_nsec
                             : 0};
}

} // namespace

std::optional<FileId> fileId(const std::filesystem::path& path) {
  return getFileId(AT_FDCWD, path.c_str(), 0);
}

std::optional<FileId> fileId(int descriptor) {
  return getFileId(descriptor, "", AT_EMPTY_PATH);
}

FileStatus readFileStatus(const std::filesystem::path& path) {
  struct stat status = {};
  if (::stat(path.c_str(), &status) != 0)
    return {.error = errno};
  return {.isFolder = S_ISDIR(status.st_mode),
          .isRegular = S_ISREG(status.st_mode),
          .bytes = static_cast<std::uint64_t>(status.st_size)};
}

int findReadError(const std::filesystem::path& path) {
  return ::faccessat(AT_FDCWD, path.c_str(), R_OK, AT_EACCESS) == 0 ? 0 : errno;
}

} // namespace fenestra::core
