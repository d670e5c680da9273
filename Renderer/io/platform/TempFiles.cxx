#include "io/platform/TempFiles.h"

#include "base/Text.h"
#include "io/platform/Descriptor.h"

#include <atomic>
#include <cerrno>
#include <cstdint>
#include <memory>
#include <mutex>
#include <new>
#include <random>

#include <dirent.h>
#include <fcntl.h>
#include <unistd.h>

namespace fenestra::core {
namespace {

constexpr std::string_view digits = "0123456789abcdef";
constexpr std::size_t digitCount = 12, checkCount = 8;

/// The last digits of FNV-1a (Fowler, Noll and Vo, 64 bits).
std::string hashDigits(std::string_view text, std::size_t count) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const char c : text)
    hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  std::string result;
  for (std::size_t i = 0; i < count; ++i, hash /= digits.size())
    result += digits[hash % digits.size()];
  return result;
}

std::string appendChecksum(const std::string& name) {
  return name + '-' + hashDigits("made by Fenestra: " + name, checkCount) + ".tmp";
}

/// True for error codes of missing files. No file has a name for which ENAMETOOLONG is reported.
bool isNotFound(int code) {
  return code == ENOENT || code == ENOTDIR || code == ENAMETOOLONG;
}

/// Locks a file of this user, or a folder accessible to this user alone, that no process has
/// locked; otherwise the result is not open.
Descriptor lockStaleFile(const std::filesystem::path& path, TempFileGuard::Kind kind) {
  Descriptor file(::open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
  struct stat status = {};
  if (::fstat(*file, &status) != 0 || status.st_uid != ::geteuid())
    return Descriptor();
  const bool isPrivate = S_ISDIR(status.st_mode) && (status.st_mode & 0777) == S_IRWXU;
  const bool isCandidate = kind == TempFileGuard::Kind::file ? S_ISREG(status.st_mode) : isPrivate;
  return isCandidate && ::flock(*file, LOCK_EX | LOCK_NB) == 0 ? std::move(file) : Descriptor();
}

static_assert(std::atomic<void*>::is_always_lock_free && std::atomic<int>::is_always_lock_free);

std::atomic<int> blockingThreads = 0;           ///< number of threads with a SignalBlocker
std::atomic<void (*)()> endRequested = nullptr; ///< set by a signal handler; null: none
thread_local int depth = 0;                     ///< number of nested SignalBlockers in this thread

void unblock() {
  if (--blockingThreads == 0)
    if (void (*end)() = endRequested)
      end();
}

} // namespace

std::string makeTempName(std::string_view prefix) {
  std::random_device random;
  return makeHashedTempName(prefix, concat(random(), ' ', random()));
}

std::string makeHashedTempName(std::string_view prefix, std::string_view what) {
  return appendChecksum(std::string(prefix) + hashDigits(what, digitCount));
}

bool isTempName(std::string_view name, std::string_view prefix) {
  return name.starts_with(prefix) &&
         name == appendChecksum(std::string(name.substr(0, prefix.size() + digitCount)));
}

struct TempFileGuard::Entry {
  std::filesystem::path path;
  Kind kind;
  bool isRegistered = true;

  bool remove() const {
    return (kind == Kind::folder ? ::rmdir(path.c_str()) : ::unlink(path.c_str())) == 0;
  }
  bool exists() const { return ::access(path.c_str(), F_OK) == 0 || !isNotFound(errno); }

  /// The registry. It changes only while a SignalBlocker exists, so that a signal handler, which
  /// runs without any, finds it unchanging.
  static std::list<Entry> all;
  static std::mutex mutex; ///< for changes to `all`
};

std::list<TempFileGuard::Entry> TempFileGuard::Entry::all;
std::mutex TempFileGuard::Entry::mutex;

TempFileGuard::TempFileGuard(const std::filesystem::path& path, Kind kind) {
  const SignalBlocker blocker;
  const std::lock_guard lock(Entry::mutex);
  m_entry = Entry::all.insert(Entry::all.end(), {path, kind});
}

TempFileGuard::~TempFileGuard() {
  const SignalBlocker blocker;
  const std::lock_guard lock(Entry::mutex);
  if (m_entry->isRegistered && !m_entry->remove() && !isNotFound(errno))
    return; // stays registered: removal is tried again when the process ends
  Entry::all.erase(m_entry);
}

const std::filesystem::path& TempFileGuard::path() const {
  return m_entry->path;
}

void TempFileGuard::release() {
  const SignalBlocker blocker;
  m_entry->isRegistered = false;
}

void removeStaleTempFiles(const std::filesystem::path& folder, std::string_view prefix,
                          TempFileGuard::Kind kind) {
  // std::filesystem's iterator ends the process if memory runs out.
  const std::unique_ptr<DIR, int (*)(DIR*)> names(::opendir(folder.c_str()), ::closedir);
  while (const dirent* const entry = names ? ::readdir(names.get()) : nullptr)
    try {
      if (!isTempName(entry->d_name, prefix))
        continue;
      const std::filesystem::path path = folder / entry->d_name;
      const Descriptor lock = lockStaleFile(path, kind);
      std::error_code ignored;
      if (lock.isOpen() && kind == TempFileGuard::Kind::file)
        ::unlink(path.c_str());
      else if (lock.isOpen())
        std::filesystem::remove_all(path, ignored);
    } catch (const std::bad_alloc&) {
      return;
    }
}

void removeAllTempFiles() {
  for (const auto kind : {TempFileGuard::Kind::file, TempFileGuard::Kind::folder})
    for (auto entry = TempFileGuard::Entry::all.rbegin(); entry != TempFileGuard::Entry::all.rend();
         ++entry)
      if (entry->isRegistered && entry->kind == kind)
        entry->remove();
}

std::vector<std::filesystem::path> remainingTempFiles() {
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : TempFileGuard::Entry::all)
    if (entry.isRegistered && entry.exists())
      paths.push_back(entry.path);
  return paths;
}

SignalBlocker::SignalBlocker() {
  if (depth++ > 0)
    return;
  ++blockingThreads;
  if (!endRequested)
    return;
  unblock();
  for (;;) // another thread ends the process
    ::pause();
}

SignalBlocker::~SignalBlocker() {
  if (--depth == 0)
    unblock();
}

void endWhenUnblocked(void (*end)()) {
  endRequested = end;
  if (blockingThreads == 0)
    end();
}

} // namespace fenestra::core
