#include "base/LargePages.h"

#include <algorithm>
#include <cstdlib>

#include <sys/mman.h>

namespace fenestra::core {
namespace {

/// Large page of x86-64, and of ARM with base pages of 4 KiB; bytes.
constexpr std::size_t largePage = std::size_t{2} << 20;
/// Alignment of small arrays, bytes: one cache line.
constexpr std::size_t cacheLine = 64;

std::size_t roundUp(std::size_t bytes, std::size_t to) {
  return (bytes + to - 1) / to * to;
}

} // namespace

void* allocateInLargePages(std::size_t bytes) {
  const std::size_t alignment = bytes < largePage ? cacheLine : largePage;
  const std::size_t size = roundUp(std::max<std::size_t>(bytes, 1), alignment);
  void* const memory = std::aligned_alloc(alignment, size);
  if (memory == nullptr)
    throw std::bad_alloc();
#ifdef MADV_HUGEPAGE
  if (alignment == largePage)
    madvise(memory, size, MADV_HUGEPAGE); // a hint: its failure is harmless
#endif
  return memory;
}

void freeLargePages(void* memory) noexcept {
  std::free(memory);
}

} // namespace fenestra::core
