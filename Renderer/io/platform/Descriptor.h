#pragma once
// File descriptors, and locks on their files (flock).

#include <cerrno>
#include <utility>

#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace fenestra::core {

/// Owns a file descriptor and closes it; -1: none.
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

/// Repeats a system call that a signal has interrupted (EINTR); returns its result.
template <typename Call>
auto retryOnEintr(Call&& systemCall) {
  auto result = systemCall();
  while (result < 0 && errno == EINTR)
    result = systemCall();
  return result;
}

/// Tries to lock a file. False if another process holds the lock; true without lock support.
inline bool tryLock(const Descriptor& file) {
  return retryOnEintr([&] { return ::flock(*file, LOCK_EX | LOCK_NB); }) == 0 ||
         errno != EWOULDBLOCK;
}

/// False if all names of the file have been removed.
inline bool hasName(const Descriptor& file) {
  struct stat status = {};
  return ::fstat(*file, &status) != 0 || status.st_nlink > 0;
}

} // namespace fenestra::core
