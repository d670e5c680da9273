#include "io/PrivateFolder.h"

#include "core/Error.h"

#include <atomic>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <string>
#include <sys/stat.h>
#include <unistd.h>

namespace fenestra {
namespace {

/// What was made, the latest first. Entries are few and stay until the process ends, so that a
/// signal handler may read them at any moment.
struct Made {
  std::string path;
  bool isFolder;
  const Made* before;
};

std::atomic<const Made*> latest = nullptr;
static_assert(std::atomic<const Made*>::is_always_lock_free);

void remember(const std::filesystem::path& path, bool isFolder) {
  auto* made = new Made{path.string(), isFolder, latest};
  while (!latest.compare_exchange_weak(made->before, made))
    ;
}

Error cannotMake(const std::filesystem::path& path) {
  return outputError(path.string(), std::string("cannot be made: ") + std::strerror(errno) +
                                        "; set TMPDIR to a folder that you may write to");
}

} // namespace

PrivateFolder::PrivateFolder() {
  std::error_code failed;
  const std::filesystem::path parent = std::filesystem::temp_directory_path(failed);
  if (failed)
    throw outputError("TMPDIR", "is no folder; set it to one that you may write to");
  std::string name = (parent / "fenestra-XXXXXX").string();
  if (!::mkdtemp(name.data())) // made with mode 0700
    throw cannotMake(name);
  m_path = name;
  remember(m_path, true);
}

PrivateFolder::~PrivateFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(m_path, ignored);
}

void PrivateFolder::addFolder(const std::filesystem::path& folder) {
  if (folder == m_path || std::filesystem::is_directory(folder))
    return;
  addFolder(folder.parent_path());
  if (::mkdir(folder.c_str(), S_IRWXU) != 0)
    throw cannotMake(folder);
  remember(folder, true);
}

std::filesystem::path PrivateFolder::add(const std::filesystem::path& relative) {
  std::filesystem::path path = m_path / relative;
  addFolder(path.parent_path());
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, S_IRUSR | S_IWUSR);
  if (file < 0)
    throw cannotMake(path);
  ::close(file);
  remember(path, false);
  return path;
}

void removePrivateFolders() {
  for (const Made* made = latest; made; made = made->before)
    if (made->isFolder)
      ::rmdir(made->path.c_str());
    else
      ::unlink(made->path.c_str());
}

} // namespace fenestra
