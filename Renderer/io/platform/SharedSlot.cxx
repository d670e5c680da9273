#include "io/platform/SharedSlot.h"

#include "base/PhysicalMemory.h"
#include "base/Text.h"
#include "io/platform/ChildProcess.h"

#include <algorithm>
#include <fcntl.h>
#include <string_view>
#include <sys/mman.h>

namespace fenestra::core {
namespace {

constexpr const char* slotName = "fenestra-slot";
constexpr std::string_view slotLink = "/memfd:fenestra-slot (deleted)";

/// Beginning of the file; all zeros: empty.
struct Header {
  std::uint64_t isUsed = 0, key = 0, size = 0;
  SharedSlot::Numbers numbers = {};
};

/// Lock of this process, not of the file's descriptor, which all processes inherit.
class Lock {
public:
  Lock(int file, short kind) : m_file(file) { set(kind); }
  Lock(const Lock&) = delete;
  Lock& operator=(const Lock&) = delete;
  ~Lock() { set(F_UNLCK); }

private:
  void set(short kind) const {
    struct flock lock = {};
    lock.l_type = kind;
    lock.l_whence = SEEK_SET;
    retryOnEintr([&] { return ::fcntl(m_file, F_SETLKW, &lock); });
  }

  int m_file;
};

template <typename Function, typename Bytes>
bool transferAll(Function&& function, int file, Bytes bytes, off_t at) {
  while (!bytes.empty()) {
    const auto count = retryOnEintr([&] { return function(file, bytes.data(), bytes.size(), at); });
    if (count <= 0)
      return false;
    bytes = bytes.subspan(static_cast<std::size_t>(count));
    at += count;
  }
  return true;
}

} // namespace

SharedSlot::SharedSlot() : m_file(::memfd_create(slotName, MFD_CLOEXEC)) {}

std::optional<SharedSlot> SharedSlot::findInherited() {
  std::array<char, 64> link = {};
  const auto size = ::readlink(concat("/proc/self/fd/", ChildProcess::inheritedFile).c_str(),
                               link.data(), link.size());
  if (size < 0 || std::string_view(link.data(), static_cast<std::size_t>(size)) != slotLink)
    return std::nullopt;
  return SharedSlot(Descriptor(::fcntl(ChildProcess::inheritedFile, F_DUPFD_CLOEXEC, 0)));
}

std::optional<SharedSlot::Numbers> SharedSlot::read(std::uint64_t key,
                                                    std::span<char> bytes) const {
  const Lock lock(*m_file, F_RDLCK);
  Header header;
  if (!transferAll(::pread, *m_file, std::span(reinterpret_cast<char*>(&header), sizeof header),
                   0) ||
      header.isUsed != 1 || header.key != key || header.size != bytes.size() ||
      !transferAll(::pread, *m_file, bytes, sizeof header))
    return std::nullopt;
  return header.numbers;
}

void SharedSlot::write(std::uint64_t key, const Numbers& numbers,
                       std::span<const char> bytes) const {
  constexpr double fraction = 0.125;
  const Lock lock(*m_file, F_WRLCK);
  if (::ftruncate(*m_file, 0) != 0 ||
      static_cast<double>(bytes.size()) > fraction * physicalMemory())
    return;
  const Header header{1, key, bytes.size(), numbers};
  const std::span head(reinterpret_cast<const char*>(&header), sizeof header);
  // Header last: it makes the result valid.
  if (transferAll(::pwrite, *m_file, bytes, sizeof header))
    transferAll(::pwrite, *m_file, head, 0);
}

} // namespace fenestra::core
