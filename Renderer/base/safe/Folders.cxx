#include "base/safe/Folders.h"

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

constexpr const char* otherFolder = "name a folder that you may write to";
constexpr const char* otherTemporary = "set TMPDIR to a folder that you may write to";

/// Makes a folder and appends it to `made`; returns the error code, 0: made.
int make(const std::filesystem::path& folder, mode_t mode, std::list<Leftover>& made) {
  const Uninterrupted making;
  made.emplace_back(folder, Leftover::Kind::folder);
  if (::mkdir(folder.c_str(), mode) == 0)
    return 0;
  const int code = errno;
  made.back().keep(); // the existing name is not ours
  return code;
}

/// Makes `folder` and the missing folders above it. Throws Error (output) with the mend `other`.
void makeMissing(const std::filesystem::path& folder, mode_t mode, const char* other,
                 std::list<Leftover>& made) {
  std::error_code failed;
  if (std::filesystem::is_directory(folder, failed))
    return;
  makeMissing(folder.parent_path(), mode, other, made);
  if (!folder.has_filename()) // `folder` ends in a slash
    return;
  if (const int code = make(folder, mode, made); code != 0)
    throw createError(folder, code, other);
}

} // namespace

MadeFolders::MadeFolders(const std::filesystem::path& folder) {
  std::error_code failed;
  const std::filesystem::path absolute = std::filesystem::absolute(folder, failed);
  if (failed)
    throw createError(folder, failed.value(), otherFolder);
  makeMissing(absolute.lexically_normal(), 0777, otherFolder, m_made);
}

MadeFolders::~MadeFolders() {
  while (!m_made.empty()) { // the innermost first
    std::error_code failed;
    if (!std::filesystem::is_empty(m_made.back().path(), failed) && !failed)
      m_made.back().keep();
    m_made.pop_back();
  }
}

/// False: another name is needed. A folder is locked after it is made; in between another run may
/// take it for abandoned and remove it.
bool PrivateFolder::makeLocked(const std::filesystem::path& folder) {
  const Uninterrupted making;
  const int code = make(folder, S_IRWXU, m_entries);
  if (code == EEXIST)
    return false;
  if (code != 0)
    throw createError(folder, code, otherTemporary);
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

std::filesystem::path PrivateFolder::add(const std::filesystem::path& relative) {
  std::filesystem::path file = path() / relative;
  makeMissing(file.parent_path(), S_IRWXU, otherTemporary, m_entries);
  const Uninterrupted making;
  m_entries.emplace_back(file, Leftover::Kind::file);
  if (!Descriptor(::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, S_IRUSR | S_IWUSR))
           .isOpen())
    throw createError(file, errno, otherTemporary);
  return file;
}

void removeAbandonedFolders() {
  std::filesystem::path parent;
  try {
    parent = temporaryFiles();
  } catch (const std::exception&) { // no folder or memory: reported where the folder is needed
    return;
  }
  removeAbandoned(parent, folderPrefix, Leftover::Kind::folder);
}

} // namespace fenestra
