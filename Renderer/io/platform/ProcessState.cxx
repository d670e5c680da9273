#include "io/platform/ProcessState.h"

#include <csignal>

#include <sys/resource.h>
#include <unistd.h>

namespace fenestra::core {
namespace {

double toSeconds(const timeval& t) {
  return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
}

} // namespace

void handleSignals(std::initializer_list<int> signals, void (*handler)(int)) {
  struct sigaction action = {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;
  sigfillset(&action.sa_mask);
  for (const int signal : signals) {
    struct sigaction before = {};
    if (::sigaction(signal, nullptr, &before) == 0 && before.sa_handler != SIG_IGN)
      ::sigaction(signal, &action, nullptr);
  }
}

void waitForEnd() {
  for (;;)
    ::pause();
}

bool isForkedProcess() {
  static const pid_t first = ::getpid();
  return ::getpid() != first;
}

ResourceUsage readResourceUsage() {
  rusage usage = {};
  ::getrusage(RUSAGE_SELF, &usage);
  return {.cpuSeconds = toSeconds(usage.ru_utime) + toSeconds(usage.ru_stime),
          .peakBytes = std::int64_t{usage.ru_maxrss} * 1024};
}

} // namespace fenestra::core
