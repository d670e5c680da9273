#include "qFenestraFolder.h"

#ifdef Q_OS_UNIX

#include <QDir>
#include <QFile>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace {

constexpr const char* lockName = "lock";

/// Opens a lock file and locks it without waiting; -1: another process holds the lock, or another
/// user owns the file.
int acquireLock(const QString& file, int flags) {
  const int lock = ::open(QFile::encodeName(file).constData(),
                          flags | O_RDWR | O_NOFOLLOW | O_CLOEXEC, S_IRUSR | S_IWUSR);
  struct stat status = {};
  if (lock < 0 || (::fstat(lock, &status) == 0 && status.st_uid == ::geteuid() &&
                   ::flock(lock, LOCK_EX | LOCK_NB) == 0))
    return lock;
  ::close(lock);
  return -1;
}

/// Removes folders with a free lock. Folders without a lock file were just created and are kept.
void removeStaleFolders(const QDir& parent, const QString& prefix) {
  const QStringList names = parent.entryList({prefix + "*"}, QDir::Dirs | QDir::NoSymLinks);
  for (const QString& name : names) {
    QDir folder(parent.filePath(name));
    const int lock = acquireLock(folder.filePath(lockName), 0);
    if (lock < 0)
      continue;
    folder.removeRecursively();
    ::close(lock);
  }
}

} // namespace

qFenestraFolder::qFenestraFolder(const QString& parent, const QString& prefix)
    : QTemporaryDir((removeStaleFolders(parent, prefix), parent + "/" + prefix + "XXXXXX")) {
  if (!isValid())
    return;
  const QString unlocked = filePath("lock.young"); // renamed once it is locked
  m_lock = acquireLock(unlocked, O_CREAT | O_EXCL);
  QFile::rename(unlocked, filePath(lockName));
}

qFenestraFolder::~qFenestraFolder() {
  remove();
  if (m_lock >= 0)
    ::close(m_lock);
}

#else // no flock: stale folders remain

qFenestraFolder::qFenestraFolder(const QString& parent, const QString& prefix)
    : QTemporaryDir(parent + "/" + prefix + "XXXXXX") {}

qFenestraFolder::~qFenestraFolder() = default;

#endif
