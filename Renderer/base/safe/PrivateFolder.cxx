#include "base/safe/PrivateFolder.h"

#include "base/Error.h"
#include "base/safe/SystemCalls.h"

#include <cerrno>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace fenestra {
namespace {

constexpr std::string_view folderPrefix = "fenestra-scene-";

std::filesystem::path temporaryFiles() {
  std::error_code failed;
  std::filesystem::path folder = std::filesystem::temp_directory_path(failed);
  if (failed)
    throw outputError("TMPDIR", "is no folder; set it to one that you may write to");
  return folder;
}

Error cannotMake(const std::filesystem::path& path) {
  const int code = errno;
  return outputError(path, "cannot be made: ", systemMessage(code), "; ",
                     writingMend(code, "set TMPDIR to a folder that you may write to"));
}

/// Locks a folder of this user, accessible to this user alone, that no process has locked. Returns
/// its descriptor; -1: failed.
int lockAbandoned(const std::filesystem::path& folder) {
  const int file = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
  struct stat status = {};
  if (file >= 0 && ::fstat(file, &status) == 0 && status.st_uid == ::geteuid() &&
      (status.st_mode & 0777) == S_IRWXU && ::flock(file, LOCK_EX | LOCK_NB) == 0)
    return file;
  if (file >= 0)
    ::close(file);
  return -1;
}

} // namespace

/// False: another name is needed. A folder is locked after it is made; in between another run may
/// take it for abandoned and remove it.
bool PrivateFolder::makeLocked(const std::filesystem::path& folder) {
  const Uninterrupted making;
  m_entries.push_back(std::make_unique<Leftover>(folder, Leftover::Kind::folder));
  if (::mkdir(folder.c_str(), S_IRWXU) != 0) {
    m_entries.back()->keep(); // the existing name is not ours
    if (errno == EEXIST)
      return false;
    throw cannotMake(folder);
  }
  m_lock = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  struct stat status = {};
  if (m_lock >= 0 && ::flock(m_lock, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
    return false;
  return m_lock < 0 || ::fstat(m_lock, &status) != 0 || status.st_nlink > 0;
}

PrivateFolder::PrivateFolder() {
  const std::filesystem::path parent = temporaryFiles();
  for (;;) {
    if (makeLocked(parent / temporaryName(folderPrefix)))
      return;
    m_entries.clear();
    if (m_lock >= 0)
      ::close(m_lock);
    m_lock = -1;
  }
}

PrivateFolder::~PrivateFolder() {
  while (!m_entries.empty()) // contents before their folder
    m_entries.pop_back();
  if (m_lock >= 0)
    ::close(m_lock);
}

void PrivateFolder::addFolder(const std::filesystem::path& folder) {
  std::error_code failed;
  if (folder == path() || std::filesystem::is_directory(folder, failed))
    return;
  addFolder(folder.parent_path());
  const Uninterrupted making;
  m_entries.push_back(std::make_unique<Leftover>(folder, Leftover::Kind::folder));
  if (::mkdir(folder.c_str(), S_IRWXU) != 0)
    throw cannotMake(folder);
}

std::filesystem::path PrivateFolder::add(const std::filesystem::path& relative) {
  std::filesystem::path file = path() / relative;
  addFolder(file.parent_path());
  const Uninterrupted making;
  m_entries.push_back(std::make_unique<Leftover>(file, Leftover::Kind::file));
  const int made = ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, S_IRUSR | S_IWUSR);
  if (made < 0)
    throw cannotMake(file);
  ::close(made);
  return file;
}

void removeAbandonedFolders() {
  std::filesystem::path parent;
  try {
    parent = temporaryFiles();
  } catch (const std::exception&) { // no folder or memory: reported where the folder is needed
    return;
  }
  forTemporaryNames(parent, folderPrefix, [](const std::filesystem::path& folder) {
    const int lock = lockAbandoned(folder);
    if (lock < 0)
      return;
    std::error_code ignored;
    std::filesystem::remove_all(folder, ignored);
    ::close(lock);
  });
}

} // namespace fenestra
