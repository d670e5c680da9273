#include "base/safe/Locks.h"

#include "base/Stopwatch.h"
#include "base/safe/Inputs.h"
#include "base/safe/SystemCalls.h"

#include <chrono>
#include <map>
#include <thread>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

namespace fenestra {
namespace {

/// Tries to lock `file`. False: another process holds the lock.
bool tryLock(int file) {
  return repeated([file] { return ::flock(file, LOCK_EX | LOCK_NB); }) == 0 || errno != EWOULDBLOCK;
}

void waitABit() {
  std::this_thread::sleep_for(std::chrono::milliseconds(2));
}

} // namespace

/// Locks folders in the order of their ids, so that two runs cannot deadlock.
FolderLocks::FolderLocks(const std::set<std::filesystem::path>& folders) {
  constexpr double longest = 2.0; // s; a script may lock the folder while it runs Fenestra
  std::map<FileId, std::filesystem::path> ordered;
  for (const std::filesystem::path& folder : folders)
    if (const auto id = fileId(folder))
      ordered.emplace(*id, folder);
  m_files.reserve(ordered.size());
  const Stopwatch waited;
  for (const auto& [id, folder] : ordered) {
    const int file = repeated(
        [&path = folder] { return ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC); });
    if (file < 0)
      continue;
    m_files.push_back(file);
    while (!tryLock(file) && waited.seconds() < longest)
      waitABit();
  }
}

FolderLocks::~FolderLocks() {
  for (const int file : m_files)
    ::close(file);
}

NameLock::NameLock(const std::filesystem::path& path) {
  constexpr double longest = 0.2; // s; removeAbandonedFiles locks files for much less
  const std::filesystem::path lock =
      path.parent_path() / temporaryNameOf(temporaryFilePrefix, path.filename().string());
  const Stopwatch waited;
  for (take(lock, path); !isHeld() && waited.seconds() < longest; take(lock, path))
    waitABit();
}

/// Fails where another process has removed the file after it was opened: no other process would see
/// that lock.
void NameLock::take(const std::filesystem::path& lock, const std::filesystem::path& path) {
  const Uninterrupted making;
  m_name.emplace(lock, Leftover::Kind::file);
  const int file = repeated(
      [&] { return ::open(lock.c_str(), O_RDONLY | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0644); });
  const int code = errno;
  if (file >= 0 && tryLock(file) && fileId(lock) == fileId(file)) {
    m_file = file;
    return;
  }
  m_name->keep(); // the file is another process's, or missing
  m_name.reset();
  if (file < 0)
    throw writingError(path, code);
  ::close(file);
}

NameLock::~NameLock() {
  m_name.reset(); // remove the name before the lock is released
  if (m_file >= 0)
    ::close(m_file);
}

} // namespace fenestra
