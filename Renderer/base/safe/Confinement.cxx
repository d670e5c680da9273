#include "base/safe/Confinement.h"

#include <algorithm>
#include <csignal>
#include <ctime>
#include <linux/landlock.h>
#include <string>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace fenestra {
namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool hasShadows = true;
#elif defined(__has_feature)
constexpr bool hasShadows = __has_feature(address_sanitizer) || __has_feature(thread_sanitizer);
#else
constexpr bool hasShadows = false;
#endif

/// Lowers a limit for good.
bool limit(__rlimit_resource resource, rlim_t most) {
  rlimit both{};
  if (::getrlimit(resource, &both) != 0)
    return false;
  both.rlim_max = std::min(both.rlim_max, most);
  both.rlim_cur = both.rlim_max;
  return ::setrlimit(resource, &both) == 0;
}

/// Gives up every right to write, make, remove and execute files; no effect on kernels without
/// Landlock.
void changeNoFolder() {
  landlock_ruleset_attr rights{};
  rights.handled_access_fs =
      LANDLOCK_ACCESS_FS_WRITE_FILE | LANDLOCK_ACCESS_FS_EXECUTE | LANDLOCK_ACCESS_FS_REMOVE_DIR |
      LANDLOCK_ACCESS_FS_REMOVE_FILE | LANDLOCK_ACCESS_FS_MAKE_CHAR | LANDLOCK_ACCESS_FS_MAKE_DIR |
      LANDLOCK_ACCESS_FS_MAKE_REG | LANDLOCK_ACCESS_FS_MAKE_SOCK | LANDLOCK_ACCESS_FS_MAKE_FIFO |
      LANDLOCK_ACCESS_FS_MAKE_BLOCK | LANDLOCK_ACCESS_FS_MAKE_SYM;
  const long rules = ::syscall(SYS_landlock_create_ruleset, &rights, sizeof rights, 0);
  if (rules < 0)
    return;
  ::syscall(SYS_landlock_restrict_self, rules, 0);
  ::close(static_cast<int>(rules));
}

} // namespace

bool confined(std::uint64_t bytes, const char* parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (std::to_string(::getppid()) != parent)
    return false; // the parent died before PR_SET_PDEATHSIG
  ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
  changeNoFolder();
  constexpr rlim_t mostFiles = 32;
  return limit(RLIMIT_CORE, 0) && limit(RLIMIT_FSIZE, 0) && limit(RLIMIT_NOFILE, mostFiles) &&
         (hasShadows || limit(RLIMIT_AS, bytes));
}

void allowSeconds(unsigned seconds) {
  const auto used = static_cast<rlim_t>(std::clock() / CLOCKS_PER_SEC);
  rlimit both{};
  ::getrlimit(RLIMIT_CPU, &both);
  both.rlim_cur = std::min(both.rlim_max, used + seconds);
  ::setrlimit(RLIMIT_CPU, &both);
}

} // namespace fenestra
