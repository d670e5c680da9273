#pragma once
// Open files, and locks on them (flock).

#include <cerrno>
#include <utility>

#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace fenestra {

/// Number of an open file, which is closed with this object; -1: none.
class Descriptor {
public:
  explicit Descriptor(int file = -1) : m_file(file) {}
  Descriptor(Descriptor&& other) noexcept : m_file(std::exchange(other.m_file, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(m_file, other.m_file);
    return *this;
  }
  ~Descriptor() {
    if (m_file >= 0)
      ::close(m_file);
  }

  bool isOpen() const { return m_file >= 0; }
  int operator*() const { return m_file; }

private:
  int m_file;
};

/// Calls `call` until no signal interrupts the call (EINTR); returns its result.
template <typename Call>
auto retryOnEintr(Call&& systemCall) {
  auto result = systemCall();
  while (result < 0 && errno == EINTR)
    result = systemCall();
  return result;
}

/// Tries to lock a file. False: another process holds the lock. True also on a disk without locks.
inline bool tryLock(const Descriptor& file) {
  return retryOnEintr([&] { return ::flock(*file, LOCK_EX | LOCK_NB); }) == 0 ||
         errno != EWOULDBLOCK;
}

/// False if the file has no name any more.
inline bool hasName(const Descriptor& file) {
  struct stat status = {};
  return ::fstat(*file, &status) != 0 || status.st_nlink > 0;
}

} // namespace fenestra
