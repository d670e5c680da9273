#include "io/platform/Locks.h"

#include "base/Stopwatch.h"
#include "io/platform/FileStatus.h"
#include "io/platform/SystemErrors.h"

#include <chrono>
#include <thread>

#include <fcntl.h>

namespace fenestra::core {
namespace {

void sleepBriefly() {
  std::this_thread::sleep_for(std::chrono::milliseconds(2));
}

} // namespace

std::vector<Descriptor> lockFolders(const std::set<std::filesystem::path>& folders) {
  constexpr double maxSeconds = 2.0; // s; a script may lock the folder while it runs Fenestra
  std::vector<Descriptor> locks;
  const Stopwatch watch;
  for (const std::filesystem::path& folder :
       folders) { // in order, so that two runs do not deadlock
    Descriptor file(
        retryOnEintr([&] { return ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC); }));
    while (file.isOpen() && !tryLock(file) && watch.seconds() < maxSeconds)
      sleepBriefly();
    locks.push_back(std::move(file));
  }
  return locks;
}

NameLock::NameLock(const std::filesystem::path& path) {
  constexpr double maxSeconds = 0.2; // s; removeStaleTempFiles holds locks for much less
  const std::filesystem::path lock =
      path.parent_path() / makeHashedTempName(tempFilePrefix, path.filename().string());
  const Stopwatch watch;
  for (tryTake(lock, path); !isHeld() && watch.seconds() < maxSeconds; tryTake(lock, path))
    sleepBriefly();
}

/// Does not take the lock if the file was removed after it was opened: other processes would not
/// see a lock on it.
void NameLock::tryTake(const std::filesystem::path& lock, const std::filesystem::path& path) {
  const SignalBlocker blocker;
  m_name.emplace(lock, TempFileGuard::Kind::file);
  Descriptor file(retryOnEintr(
      [&] { return ::open(lock.c_str(), O_RDONLY | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0644); }));
  const int code = errno;
  if (file.isOpen() && tryLock(file) && fileId(lock) == fileId(*file)) {
    m_file = std::move(file);
    return;
  }
  m_name->release(); // the file is another process's, or missing
  m_name.reset();
  if (!file.isOpen())
    throw writeError(path, code);
}

} // namespace fenestra::core
