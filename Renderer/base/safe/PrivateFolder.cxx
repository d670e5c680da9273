#include "base/safe/PrivateFolder.h"

#include "base/Error.h"
#include "base/safe/SystemCalls.h"

#include <fcntl.h>

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
  return makingError(path, errno, "set TMPDIR to a folder that you may write to");
}

/// Lock on a folder of this user, accessible to this user alone, that no process has locked; not
/// open: there is none.
Descriptor lockAbandoned(const std::filesystem::path& folder) {
  Descriptor file(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
  struct stat status = {};
  const bool isLocked = ::fstat(*file, &status) == 0 && status.st_uid == ::geteuid() &&
                        (status.st_mode & 0777) == S_IRWXU &&
                        ::flock(*file, LOCK_EX | LOCK_NB) == 0;
  return isLocked ? std::move(file) : Descriptor();
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
  m_lock = Descriptor(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  return !m_lock.isOpen() || (tryLock(m_lock) && hasName(m_lock));
}

PrivateFolder::PrivateFolder() {
  const std::filesystem::path parent = temporaryFiles();
  while (!makeLocked(parent / temporaryName(folderPrefix)))
    m_entries.clear();
}

PrivateFolder::~PrivateFolder() {
  while (!m_entries.empty()) // contents before their folder
    m_entries.pop_back();
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
  if (!Descriptor(::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, S_IRUSR | S_IWUSR))
           .isOpen())
    throw cannotMake(file);
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
    std::error_code ignored;
    if (const Descriptor lock = lockAbandoned(folder); lock.isOpen())
      std::filesystem::remove_all(folder, ignored);
  });
}

} // namespace fenestra
