#include "Calls.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include <linux/filter.h>
#include <linux/limits.h>
#include <linux/seccomp.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <sys/user.h>
#include <unistd.h>

namespace fenestra::core::faults {
namespace {

/// System call; `argument` is the index, from 0, of its path or descriptor.
struct FileCall {
  const char* name;
  unsigned number;
  enum class About { path, descriptor, nothing } about = About::nothing;
  int argument = 0;
  bool isChange = false; ///< changes a file or folder
};

using enum FileCall::About;

constexpr FileCall calls[] = {
    {"open", SYS_open, path},
    {"openat", SYS_openat, path, 1},
    {"creat", SYS_creat, path},
    {"memfd_create", SYS_memfd_create, path},
    {"read", SYS_read, descriptor},
    {"pread64", SYS_pread64, descriptor},
    {"readv", SYS_readv, descriptor},
    {"write", SYS_write, descriptor, 0, true},
    {"pwrite64", SYS_pwrite64, descriptor, 0, true},
    {"writev", SYS_writev, descriptor, 0, true},
    {"pwritev", SYS_pwritev, descriptor, 0, true},
    {"sendfile", SYS_sendfile, descriptor, 0, true},
    {"copy_file_range", SYS_copy_file_range, descriptor, 2, true},
    {"close", SYS_close, descriptor},
    {"rename", SYS_rename, path, 1, true},
    {"renameat", SYS_renameat, path, 3, true},
    {"renameat2", SYS_renameat2, path, 3, true},
    {"link", SYS_link, path, 1, true},
    {"linkat", SYS_linkat, path, 3, true},
    {"symlink", SYS_symlink, path, 1, true},
    {"symlinkat", SYS_symlinkat, path, 2, true},
    {"unlink", SYS_unlink, path, 0, true},
    {"unlinkat", SYS_unlinkat, path, 1, true},
    {"rmdir", SYS_rmdir, path, 0, true},
    {"mkdir", SYS_mkdir, path},
    {"mkdirat", SYS_mkdirat, path, 1},
    {"fsync", SYS_fsync, descriptor},
    {"fdatasync", SYS_fdatasync, descriptor},
    {"syncfs", SYS_syncfs, descriptor},
    {"ftruncate", SYS_ftruncate, descriptor},
    {"truncate", SYS_truncate, path},
    {"fallocate", SYS_fallocate, descriptor},
    {"stat", SYS_stat, path},
    {"lstat", SYS_lstat, path},
    {"fstat", SYS_fstat, descriptor},
    {"newfstatat", SYS_newfstatat, path, 1},
    {"statx", SYS_statx, path, 1},
    {"statfs", SYS_statfs, path},
    {"fstatfs", SYS_fstatfs, descriptor},
    {"access", SYS_access, path},
    {"faccessat", SYS_faccessat, path, 1},
    {"faccessat2", SYS_faccessat2, path, 1},
    {"readlink", SYS_readlink, path},
    {"readlinkat", SYS_readlinkat, path, 1},
    {"getcwd", SYS_getcwd},
    {"chmod", SYS_chmod, path},
    {"fchmod", SYS_fchmod, descriptor},
    {"fchmodat", SYS_fchmodat, path, 1},
    {"chown", SYS_chown, path},
    {"fchown", SYS_fchown, descriptor},
    {"fchownat", SYS_fchownat, path, 1},
    {"utimensat", SYS_utimensat, path, 1},
    {"getdents64", SYS_getdents64, descriptor},
    {"lseek", SYS_lseek, descriptor},
    {"flock", SYS_flock, descriptor},
    {"mmap", SYS_mmap, descriptor, 4},
};

const FileCall* findCall(unsigned long long number) {
  const auto* call = std::find_if(std::begin(calls), std::end(calls),
                                  [number](const FileCall& c) { return c.number == number; });
  return call == std::end(calls) ? nullptr : call;
}

std::string readText(pid_t thread, unsigned long long address) {
  std::array<char, 256> text = {};
  iovec here = {text.data(), text.size() - 1};
  // NOLINTNEXTLINE(performance-no-int-to-ptr): an address of another process
  iovec there = {reinterpret_cast<void*>(address), text.size() - 1};
  if (address == 0 || ::process_vm_readv(thread, &here, 1, &there, 1, 0) <= 0)
    return "";
  return text.data();
}

std::string findFile(pid_t thread, long long descriptor) {
  std::array<char, PATH_MAX> target = {};
  const std::string link =
      "/proc/" + std::to_string(thread) + "/fd/" + std::to_string(static_cast<int>(descriptor));
  const ssize_t length = ::readlink(link.c_str(), target.data(), target.size());
  return length > 0 ? std::string(target.data(), static_cast<std::size_t>(length))
                    : std::to_string(static_cast<int>(descriptor));
}

unsigned long long readArgument(const user_regs_struct& registers, int index) {
  const unsigned long long all[] = {registers.rdi, registers.rsi, registers.rdx,
                                    registers.r10, registers.r8,  registers.r9};
  return all[index];
}

std::vector<sock_filter> makeFilter() {
  // An instruction is its code, how many to skip if equal and if not, and its operand.
  constexpr auto load = static_cast<std::uint16_t>(BPF_LD | BPF_W | BPF_ABS);
  constexpr auto equal = static_cast<std::uint16_t>(BPF_JMP | BPF_JEQ | BPF_K);
  constexpr auto ret = static_cast<std::uint16_t>(BPF_RET | BPF_K);
  const sock_filter trace = {ret, 0, 0, SECCOMP_RET_TRACE};
  const sock_filter allow = {ret, 0, 0, SECCOMP_RET_ALLOW};
  std::vector<sock_filter> filter = {{load, 0, 0, offsetof(seccomp_data, nr)}};
  for (const FileCall& call : calls)
    if (call.number != SYS_mmap) {
      filter.push_back({equal, 0, 1, call.number});
      filter.push_back(trace);
    }
  filter.push_back({equal, 1, 0, SYS_mmap});
  filter.push_back(allow);
  // Anonymous mappings have descriptor -1.
  filter.push_back({load, 0, 0, offsetof(seccomp_data, args) + 4 * sizeof(std::uint64_t)});
  filter.push_back({equal, 0, 1, ~0U});
  filter.push_back(allow);
  filter.push_back(trace);
  return filter;
}

} // namespace

std::span<const sock_filter> fileCallFilter() {
  static const std::vector<sock_filter> filter = makeFilter();
  return filter;
}

bool isChange(const user_regs_struct& registers) {
  const FileCall* call = findCall(registers.orig_rax);
  return call && call->isChange;
}

std::string describeCall(pid_t thread, const user_regs_struct& registers) {
  const FileCall* call = findCall(registers.orig_rax);
  if (!call)
    return "call " + std::to_string(registers.orig_rax);
  const unsigned long long about = readArgument(registers, call->argument);
  switch (call->about) {
  case path:
    return std::string(call->name) + " " + readText(thread, about);
  case descriptor:
    return std::string(call->name) + " " + findFile(thread, static_cast<long long>(about));
  default:
    return call->name;
  }
}

} // namespace fenestra::core::faults
