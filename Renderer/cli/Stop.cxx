#include "cli/Stop.h"

#include "io/Leftovers.h"

#include <csignal>
#include <unistd.h>

namespace fenestra {
namespace {

std::atomic<std::atomic<bool>*> flag = nullptr;
static_assert(std::atomic<std::atomic<bool>*>::is_always_lock_free);

/// Only what a signal handler may do.
void onSignal(int) {
  if (std::atomic<bool>* stop = flag) {
    *stop = true;
    return;
  }
  static constexpr char line[] = "fenestra: stopped on request; nothing was written\n";
  [[maybe_unused]] const auto written = ::write(STDERR_FILENO, line, sizeof line - 1);
  endStopped();
}

void handle(void (*handler)(int)) {
  struct sigaction action = {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  for (const int signal : {SIGINT, SIGTERM})
    sigaction(signal, &action, nullptr);
}

} // namespace

void endStopped() {
  removeLeftovers();
  ::_exit(stoppedStatus);
}

StopOnSignal::StopOnSignal() {
  handle(onSignal);
}

StopOnSignal::~StopOnSignal() {
  handle(SIG_DFL);
  flag = nullptr;
}

void StopOnSignal::setInstead(std::atomic<bool>& stop) {
  flag = &stop;
}

} // namespace fenestra
