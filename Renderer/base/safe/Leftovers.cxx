#include "base/safe/Leftovers.h"

#include "base/Text.h"
#include "base/safe/Descriptor.h"

#include <atomic>
#include <cerrno>
#include <cstdint>
#include <memory>
#include <new>
#include <random>

#include <dirent.h>
#include <fcntl.h>
#include <unistd.h>

namespace fenestra {
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

std::string withCheck(const std::string& name) {
  return name + '-' + hashDigits("made by Fenestra: " + name, checkCount) + ".tmp";
}

/// True for error codes that mean that no such file exists. No file has a name that is too long.
bool saysNothingIsThere(int code) {
  return code == ENOENT || code == ENOTDIR || code == ENAMETOOLONG;
}

/// Lock on a file of this user, or on a folder accessible to this user alone, that no process has
/// locked; not open: there is none.
Descriptor lockAbandoned(const std::filesystem::path& path, Leftover::Kind kind) {
  Descriptor file(::open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
  struct stat status = {};
  if (::fstat(*file, &status) != 0 || status.st_uid != ::geteuid())
    return Descriptor();
  const bool isPrivate = S_ISDIR(status.st_mode) && (status.st_mode & 0777) == S_IRWXU;
  const bool isRight = kind == Leftover::Kind::file ? S_ISREG(status.st_mode) : isPrivate;
  return isRight && ::flock(*file, LOCK_EX | LOCK_NB) == 0 ? std::move(file) : Descriptor();
}

static_assert(std::atomic<void*>::is_always_lock_free && std::atomic<bool>::is_always_lock_free);

std::atomic<int> uninterrupted = 0;             ///< number of threads that are Uninterrupted
std::atomic<void (*)()> endRequested = nullptr; ///< set by a signal handler; null: none
thread_local int depth = 0;                     ///< number of nested Uninterrupted in this thread

void leave() {
  if (--uninterrupted == 0)
    if (void (*end)() = endRequested)
      end();
}

} // namespace

std::string temporaryName(std::string_view prefix) {
  std::random_device random;
  return temporaryNameOf(prefix, textOf(random(), ' ', random()));
}

std::string temporaryNameOf(std::string_view prefix, std::string_view what) {
  return withCheck(std::string(prefix) + hashDigits(what, digitCount));
}

bool isTemporaryName(std::string_view name, std::string_view prefix) {
  return name.starts_with(prefix) &&
         name == withCheck(std::string(name.substr(0, prefix.size() + digitCount)));
}

/// Entry of the list. Entries are reused, never freed: a signal handler may walk the list at any
/// time.
struct Leftover::Entry {
  std::filesystem::path path; ///< constant while listed
  Kind kind = Kind::file;
  std::atomic<bool> isTaken = false;
  std::atomic<bool> isListed = false;
  Entry* next = nullptr;

  static std::atomic<Entry*> first;

  /// Takes a free entry, or a new one.
  static Entry* take() {
    for (Entry* entry = first; entry; entry = entry->next)
      if (!entry->isTaken.exchange(true))
        return entry;
    auto* entry = new Entry;
    entry->isTaken = true;
    entry->next = first;
    while (!first.compare_exchange_weak(entry->next, entry))
      ;
    return entry;
  }

  bool remove() const {
    return (kind == Kind::folder ? ::rmdir(path.c_str()) : ::unlink(path.c_str())) == 0;
  }
  bool isThere() const { return ::access(path.c_str(), F_OK) == 0 || !saysNothingIsThere(errno); }
};

std::atomic<Leftover::Entry*> Leftover::Entry::first = nullptr;

Leftover::Leftover(const std::filesystem::path& path, Kind kind) {
  std::filesystem::path copy = path; // may throw, before an entry is taken
  m_entry = Entry::take();
  m_entry->path = std::move(copy);
  m_entry->kind = kind;
  m_entry->isListed = true;
}

Leftover::~Leftover() {
  if (m_entry->isListed && !m_entry->remove() && !saysNothingIsThere(errno))
    return; // the name stays listed: the end of the process tries again
  m_entry->isListed = false;
  m_entry->isTaken = false;
}

const std::filesystem::path& Leftover::path() const {
  return m_entry->path;
}

void Leftover::keep() {
  m_entry->isListed = false;
}

void removeAbandoned(const std::filesystem::path& folder, std::string_view prefix,
                     Leftover::Kind kind) {
  // std::filesystem's iterator ends the process where memory fails.
  const std::unique_ptr<DIR, int (*)(DIR*)> names(::opendir(folder.c_str()), ::closedir);
  while (const dirent* const entry = names ? ::readdir(names.get()) : nullptr)
    try {
      if (!isTemporaryName(entry->d_name, prefix))
        continue;
      const std::filesystem::path path = folder / entry->d_name;
      const Descriptor lock = lockAbandoned(path, kind);
      std::error_code ignored;
      if (lock.isOpen() && kind == Leftover::Kind::file)
        ::unlink(path.c_str());
      else if (lock.isOpen())
        std::filesystem::remove_all(path, ignored);
    } catch (const std::bad_alloc&) {
      return;
    }
}

void removeLeftovers() {
  for (const auto* entry = Leftover::Entry::first.load(); entry; entry = entry->next)
    if (entry->isListed && entry->kind == Leftover::Kind::file)
      entry->remove();
  for (bool isDone = false; !isDone;) { // nested folders: repeat until none can be removed
    isDone = true;
    for (const auto* entry = Leftover::Entry::first.load(); entry; entry = entry->next)
      if (entry->isListed && entry->kind == Leftover::Kind::folder && entry->remove())
        isDone = false;
  }
}

std::vector<std::filesystem::path> remainingLeftovers() {
  std::vector<std::filesystem::path> paths;
  for (const auto* entry = Leftover::Entry::first.load(); entry; entry = entry->next)
    if (entry->isListed && entry->isThere())
      paths.push_back(entry->path);
  return paths;
}

Uninterrupted::Uninterrupted() {
  if (depth++ > 0)
    return;
  ++uninterrupted;
  if (!endRequested)
    return;
  leave();
  for (;;) // another thread ends the process
    ::pause();
}

Uninterrupted::~Uninterrupted() {
  if (--depth == 0)
    leave();
}

void endWhenPossible(void (*end)()) {
  endRequested = end;
  if (uninterrupted == 0)
    end();
}

} // namespace fenestra
