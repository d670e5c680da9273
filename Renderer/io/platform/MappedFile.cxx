#include "io/platform/MappedFile.h"

#include "io/platform/SystemErrors.h"

#include <fcntl.h>
#include <sys/mman.h>

namespace fenestra::core {

MappedFile::MappedFile(const std::filesystem::path& path)
    : m_path(path), m_file(retryOnEintr([&] {
        return ::open(path.c_str(), O_RDWR | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
      })) {
  if (!m_file.isOpen())
    throw writeError(path, errno);
  struct stat status = {};
  if (::fstat(*m_file, &status) != 0 || !S_ISREG(status.st_mode))
    throw outputError(path, "is not a regular file; name a file in a folder that you may write to");
}

MappedFile::~MappedFile() {
  unmap();
}

void MappedFile::unmap() {
  if (!m_bytes.empty())
    ::munmap(m_bytes.data(), m_bytes.size());
  m_bytes = {};
}

void MappedFile::extend(std::size_t size) {
  constexpr std::size_t page = 4096;
  size = (size + page - 1) / page * page;
  if (size <= m_bytes.size())
    return;
  // Without reserved space, a full disk would end the process when it writes to the memory.
  if (const int failure = ::posix_fallocate(*m_file, 0, static_cast<off_t>(size)); failure != 0)
    throw writeError(m_path, failure);
  void* const memory = ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, *m_file, 0);
  if (memory == MAP_FAILED)
    throw writeError(m_path, errno);
  unmap();
  m_bytes = {static_cast<std::byte*>(memory), size};
}

} // namespace fenestra::core
