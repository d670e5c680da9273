#include "io/platform/Folders.h"

#include "base/Error.h"
#include "io/platform/SystemErrors.h"

#include <fcntl.h>

namespace fenestra::core {
namespace {

constexpr std::string_view folderPrefix = "fenestra-scene-";

std::filesystem::path findTempRoot() {
  std::error_code failed;
  std::filesystem::path folder = std::filesystem::temp_directory_path(failed);
  if (failed)
    throw outputError("TMPDIR", "is not a folder; set it to one that you may write to");
  return folder;
}

constexpr const char* folderHint = "name a folder that you may write to";
constexpr const char* tempHint = "set TMPDIR to a folder that you may write to";

/// Creates a folder and appends it to `created`; returns the error code, 0: success.
int createFolder(const std::filesystem::path& folder, mode_t mode,
                 std::list<TempFileGuard>& created) {
  const SignalBlocker blocker;
  created.emplace_back(folder, TempFileGuard::Kind::folder);
  if (::mkdir(folder.c_str(), mode) == 0)
    return 0;
  const int code = errno;
  created.back().release(); // not created by this process
  return code;
}

/// Creates `folder` and its missing parents. Throws Error (output) with `hint`.
void createMissing(const std::filesystem::path& folder, mode_t mode, const char* hint,
                   std::list<TempFileGuard>& created) {
  std::error_code failed;
  if (std::filesystem::is_directory(folder, failed))
    return;
  createMissing(folder.parent_path(), mode, hint, created);
  if (!folder.has_filename()) // `folder` ends in a slash
    return;
  if (const int code = createFolder(folder, mode, created); code != 0)
    throw createError(folder, code, hint);
}

} // namespace

CreatedFolders::CreatedFolders(const std::filesystem::path& folder) {
  std::error_code failed;
  const std::filesystem::path absolute = std::filesystem::absolute(folder, failed);
  if (failed)
    throw createError(folder, failed.value(), folderHint);
  createMissing(absolute.lexically_normal(), 0777, folderHint, m_created);
}

CreatedFolders::~CreatedFolders() {
  while (!m_created.empty()) { // the innermost first
    std::error_code failed;
    if (!std::filesystem::is_empty(m_created.back().path(), failed) && !failed)
      m_created.back().release();
    m_created.pop_back();
  }
}

/// False: the name is taken; try another. The folder is locked only after its creation; in between
/// another run may consider it stale and remove it.
bool PrivateFolder::makeLocked(const std::filesystem::path& folder) {
  const SignalBlocker blocker;
  const int code = createFolder(folder, S_IRWXU, m_entries);
  if (code == EEXIST)
    return false;
  if (code != 0)
    throw createError(folder, code, tempHint);
  m_lock = Descriptor(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  return !m_lock.isOpen() || (tryLock(m_lock) && hasName(m_lock));
}

PrivateFolder::PrivateFolder() {
  removeStaleFolders();
  const std::filesystem::path parent = findTempRoot();
  while (!makeLocked(parent / makeTempName(folderPrefix)))
    m_entries.clear();
}

PrivateFolder::~PrivateFolder() {
  while (!m_entries.empty()) // contents before their folder
    m_entries.pop_back();
}

std::filesystem::path PrivateFolder::add(const std::filesystem::path& relative) {
  std::filesystem::path file = path() / relative;
  createMissing(file.parent_path(), S_IRWXU, tempHint, m_entries);
  const SignalBlocker blocker;
  m_entries.emplace_back(file, TempFileGuard::Kind::file);
  if (!Descriptor(::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, S_IRUSR | S_IWUSR))
           .isOpen())
    throw createError(file, errno, tempHint);
  return file;
}

void removeStaleFolders() {
  std::filesystem::path parent;
  try {
    parent = findTempRoot();
  } catch (const std::exception&) { // no folder or memory: the first user of the folder reports it
    return;
  }
  removeStaleTempFiles(parent, folderPrefix, TempFileGuard::Kind::folder);
}

} // namespace fenestra::core
