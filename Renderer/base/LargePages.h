#pragma once
// Arrays in large pages of memory. A path looks a volume up all over: with pages of 4 KiB the
// processor's table of addresses misses about as often as its cache, and on a volume of 64 MiB that
// took a fifth of the time.

#include <cstddef>
#include <new>
#include <vector>

namespace fenestra {

/// Memory of at least `bytes`, never a null pointer; in large pages where that is worth while and
/// the system has them (Linux: transparent huge pages, if `always` or `madvise`). A page is taken
/// when it is first touched. Throws std::bad_alloc.
void* allocateInLargePages(std::size_t bytes);
void freeLargePages(void* memory) noexcept;

/// Allocator of such arrays.
template <typename T>
struct LargePages {
  using value_type = T;

  LargePages() = default;
  template <typename Other>
  LargePages(const LargePages<Other>&) {}

  T* allocate(std::size_t count) {
    if (count > static_cast<std::size_t>(-1) / 2 / sizeof(T))
      throw std::bad_array_new_length();
    return static_cast<T*>(allocateInLargePages(count * sizeof(T)));
  }
  void deallocate(T* memory, std::size_t) noexcept { freeLargePages(memory); }

  friend bool operator==(const LargePages&, const LargePages&) { return true; }
};

template <typename T>
using LargeArray = std::vector<T, LargePages<T>>;

} // namespace fenestra
