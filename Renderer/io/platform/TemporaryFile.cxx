#include "io/platform/TemporaryFile.h"

#include "io/platform/SystemErrors.h"

#include <array>
#include <cstdio>
#include <fcntl.h>
#include <sys/xattr.h>

namespace fenestra::core {
namespace {

std::filesystem::path makeSiblingName(const std::filesystem::path& target) {
  return target.parent_path() / makeTempName(tempFilePrefix);
}

/// Copies the access control list (acl(5)), if any, from `from` to `to`. False: cannot be set.
bool copyAccessList(const std::filesystem::path& from, int to) {
  constexpr const char* attribute = "system.posix_acl_access";
  std::array<char, 4096> list;
  const ssize_t size = ::lgetxattr(from.c_str(), attribute, list.data(), list.size());
  if (size < 0)
    return errno == ENODATA || errno == ENOTSUP;
  return ::fsetxattr(to, attribute, list.data(), static_cast<std::size_t>(size), 0) == 0;
}

/// Mode of the previous file. If its group cannot be set, the group's rights are reduced to those
/// that others have as well.
mode_t inheritMode(const struct stat& before, bool hasSameGroup) {
  const mode_t mode = before.st_mode & 0777;
  const mode_t groupAsOthers = (mode & 07) << 3;
  return hasSameGroup ? mode : (mode & ~mode_t{070}) | (mode & groupAsOthers);
}

} // namespace

TemporaryFile::TemporaryFile(const std::filesystem::path& target) : m_target(target) {
  open();
  if (!m_file.isOpen())
    throw writeError(m_target, errno);
}

/// Creates the file, then locks it. Creates another if a later run has removed it in between as
/// stale. A new file gets its final mode from the umask; one that replaces another is private until
/// finish().
void TemporaryFile::open() {
  struct stat before = {};
  const mode_t mode = ::lstat(m_target.c_str(), &before) == 0 ? 0600 : 0666;
  for (;;) {
    const SignalBlocker blocker;
    m_name.emplace(makeSiblingName(m_target), TempFileGuard::Kind::file);
    m_file = Descriptor(retryOnEintr([&] {
      return ::open(m_name->path().c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, mode);
    }));
    if (!m_file.isOpen() && errno == EEXIST)
      m_name->release(); // another process's file
    else if (!m_file.isOpen() || (tryLock(m_file) && hasName(m_file)))
      return;
  }
}

void TemporaryFile::write(std::string_view content) {
  writeAll(*m_file, content, m_target);
}

void TemporaryFile::finish(Durability durability) {
  struct stat before = {};
  if (::lstat(m_target.c_str(), &before) == 0) {
    const bool isOwned = ::fchown(*m_file, before.st_uid, before.st_gid) == 0;
    const bool hasSameGroup = isOwned || ::fchown(*m_file, uid_t(-1), before.st_gid) == 0;
    const mode_t mode = inheritMode(before, hasSameGroup);
    const mode_t ownerOnly = mode & 0700; // the mode's group bits are the ACL's mask
    if (retryOnEintr([&] { return ::fchmod(*m_file, mode); }) != 0 ||
        (!copyAccessList(m_target, *m_file) && ::fchmod(*m_file, ownerOnly) != 0))
      throw writeError(m_target, errno);
  }
  if (durability == Durability::synced && retryOnEintr([&] { return ::fsync(*m_file); }) != 0 &&
      errno != EINVAL)
    throw writeError(m_target, errno);
}

void TemporaryFile::place() {
  const char* const name = m_name->path().c_str();
  const char* const target = m_target.c_str();
  m_replaced = Descriptor(::open(target, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
  if (m_replaced.isOpen()) // locked if readable: other runs must not consider it stale
    ::flock(*m_replaced, LOCK_SH | LOCK_NB);
  const auto rename = [&](unsigned flags) {
    return retryOnEintr([&] { return ::renameat2(AT_FDCWD, name, AT_FDCWD, target, flags); }) == 0;
  };
  if (rename(RENAME_NOREPLACE))
    m_placed = Placed::fresh;
  else if (errno == EEXIST && rename(RENAME_EXCHANGE))
    m_placed = Placed::exchanged;
  else if (errno == EINVAL || errno == ENOSYS)
    placeByLink();
  else
    throw writeError(m_target, errno);
}

/// Places the file on file systems that cannot exchange names. A hard link preserves the previous
/// file; without hard links, placing cannot be undone.
void TemporaryFile::placeByLink() {
  m_before.emplace(makeSiblingName(m_target), TempFileGuard::Kind::file);
  const bool hasBackup = ::link(m_target.c_str(), m_before->path().c_str()) == 0;
  const bool isFresh = !hasBackup && errno == ENOENT;
  if (retryOnEintr([&] { return ::rename(m_name->path().c_str(), m_target.c_str()); }) != 0)
    throw writeError(m_target, errno);
  m_placed = isFresh ? Placed::fresh : hasBackup ? Placed::linked : Placed::no;
}

void TemporaryFile::undoPlace() noexcept {
  if (fileId(m_target) != fileId(*m_file)) // another run has since placed a result of this name
    m_placed = Placed::no;
  const char* const name = m_name->path().c_str();
  const char* const target = m_target.c_str();
  const auto retryOnce = [](auto&& call) { // retries once: a failure may be temporary
    if (call() != 0)
      static_cast<void>(call());
  };
  if (m_placed == Placed::exchanged)
    retryOnce([&] { return ::renameat2(AT_FDCWD, name, AT_FDCWD, target, RENAME_EXCHANGE); });
  else if (m_placed == Placed::fresh)
    retryOnce([&] { return ::unlink(target); });
  else if (m_placed == Placed::linked)
    retryOnce([&] { return ::rename(m_before->path().c_str(), target); });
  m_placed = Placed::no;
}

} // namespace fenestra::core
