// Library for LD_PRELOAD in the process under test. From the start of `main`, which it reports to
// the tracer, it counts allocations and lets one fail. It also records the stack at a crash.
#include "Page.h"

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <type_traits>

#include <dlfcn.h>
#include <execinfo.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

extern "C" {
// The allocator of glibc.
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
}

namespace {

using fenestra::core::faults::Page;

Page* page = nullptr; ///< null until `main` starts

bool shouldFail() {
  if (!page || ++page->allocations != page->failingNumber)
    return false;
  errno = ENOMEM;
  return true;
}

/// Writes the stack of a crash to the page, then raises the signal with its default action.
void onCrash(int signal) {
  int none = 0;
  if (page->signal.compare_exchange_strong(none, signal)) {
    void* addresses[std::extent_v<decltype(Page::frames)>];
    const int count = ::backtrace(addresses, static_cast<int>(std::extent_v<decltype(addresses)>));
    for (int i = 0; i < count; ++i) {
      Dl_info info = {};
      if (::dladdr(addresses[i], &info) == 0 || !info.dli_fname)
        continue;
      fenestra::core::faults::Frame& frame = page->frames[page->frameCount++];
      std::strncpy(frame.module, info.dli_fname, sizeof frame.module - 1);
      if (info.dli_sname)
        std::strncpy(frame.function, info.dli_sname, sizeof frame.function - 1);
      frame.address = reinterpret_cast<std::uintptr_t>(addresses[i]) -
                      reinterpret_cast<std::uintptr_t>(info.dli_fbase);
    }
  }
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

using Main = int (*)(int, char**, char**);
Main realMain = nullptr;

int tracedMain(int count, char** words, char** environment) {
  const char* const file = std::getenv(fenestra::core::faults::pageVariable);
  const int opened = file ? ::open(file, O_RDWR | O_CLOEXEC) : -1;
  if (opened >= 0) {
    void* const shared =
        ::mmap(nullptr, sizeof(Page), PROT_READ | PROT_WRITE, MAP_SHARED, opened, 0);
    ::close(opened);
    void* unused[1];
    ::backtrace(unused, 1); // loads libgcc now, so that a crash handler need not allocate
    for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT})
      std::signal(signal, onCrash);
    if (shared != MAP_FAILED)
      page = static_cast<Page*>(shared);
  }
  ::syscall(SYS_lseek, -1, 0, fenestra::core::faults::mainMarker);
  return realMain(count, words, environment);
}

} // namespace

extern "C" {

void* malloc(std::size_t size) {
  return shouldFail() ? nullptr : __libc_malloc(size);
}

void* calloc(std::size_t count, std::size_t size) {
  return shouldFail() ? nullptr : __libc_calloc(count, size);
}

void* realloc(void* memory, std::size_t size) {
  return shouldFail() ? nullptr : __libc_realloc(memory, size);
}

void* memalign(std::size_t alignment, std::size_t size) {
  return shouldFail() ? nullptr : __libc_memalign(alignment, size);
}

void* aligned_alloc(std::size_t alignment, std::size_t size) {
  return memalign(alignment, size);
}

int posix_memalign(void** memory, std::size_t alignment, std::size_t size) {
  void* const allocated = memalign(alignment, size);
  if (!allocated)
    return ENOMEM;
  *memory = allocated;
  return 0;
}

int __libc_start_main(Main main, int count, char** words, void (*begin)(), void (*end)(),
                      void (*linkerEnd)(), void* stack) {
  const auto start =
      reinterpret_cast<decltype(&__libc_start_main)>(::dlsym(RTLD_NEXT, "__libc_start_main"));
  realMain = main;
  return start(tracedMain, count, words, begin, end, linkerEnd, stack);
}
}
