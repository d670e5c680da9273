#include "io/AtomicFile.h"

#include "core/Error.h"

#include <atomic>
#include <cerrno>
#include <string>
#include <system_error>

#include <fcntl.h>
#include <unistd.h>

namespace fenestra {

namespace {

Error systemError(const std::filesystem::path& path, int code, const std::string& mend) {
  return outputError(path.string(),
                     "cannot be written: " + std::generic_category().message(code) + "; " + mend);
}

const char* const folderMend = "name a file in an existing folder that you may write to";
const char* const spaceMend = "free some space or name a file elsewhere";

/// A name that no other writer uses, in this process or another: "picture.png" becomes
/// ".fenestra-<process>-<number>-picture.png".
std::filesystem::path temporaryName(const std::filesystem::path& path) {
  static std::atomic<unsigned> number{0};
  const std::string prefix =
      ".fenestra-" + std::to_string(getpid()) + "-" + std::to_string(number++) + "-";
  return path.parent_path() / (prefix + path.filename().string());
}

void writeAll(int file, std::string_view content, const std::filesystem::path& path) {
  while (!content.empty()) {
    const ssize_t written = ::write(file, content.data(), content.size());
    if (written > 0)
      content.remove_prefix(static_cast<std::size_t>(written));
    else if (errno != EINTR)
      throw systemError(path, errno, spaceMend);
  }
}

} // namespace

AtomicFile::AtomicFile(std::filesystem::path path) : m_path(std::move(path)) {
  std::error_code ignored;
  const auto status = std::filesystem::status(m_path, ignored);
  if (!m_path.has_filename() ||
      (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)))
    throw outputError(m_path.string(), "is a folder or a device; name a file");
  int file = -1;
  do { // another host's process of the same number may have left this name in a shared folder
    m_temporary = temporaryName(m_path);
    file = ::open(m_temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  } while (file < 0 && (errno == EEXIST || errno == EINTR));
  if (file < 0)
    throw systemError(m_path, errno, folderMend);
  ::close(file);
}

AtomicFile::~AtomicFile() {
  std::error_code ignored;
  if (!m_committed)
    std::filesystem::remove(m_temporary, ignored);
}

void AtomicFile::commit() {
  std::error_code error;
  std::filesystem::rename(m_temporary, m_path, error);
  if (error)
    throw systemError(m_path, error.value(), folderMend);
  m_committed = true;
}

void checkWritable(const std::filesystem::path& path) {
  const AtomicFile probe(path);
}

void writeFile(const std::filesystem::path& path, std::string_view content) {
  AtomicFile atomic(path);
  const int file = ::open(atomic.temporaryPath().c_str(), O_WRONLY | O_CLOEXEC);
  if (file < 0)
    throw systemError(path, errno, folderMend);
  try {
    writeAll(file, content, path);
  } catch (...) {
    ::close(file);
    throw;
  }
  if (::close(file) != 0) // where a network file system tells of a full disk
    throw systemError(path, errno, spaceMend);
  atomic.commit();
}

} // namespace fenestra
