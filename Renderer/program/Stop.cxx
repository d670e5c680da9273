#include "program/Stop.h"

#include "base/Error.h"
#include "io/Outputs.h"
#include "io/platform/ProcessState.h"
#include "io/platform/Streams.h"
#include "io/platform/TempFiles.h"
#include "program/ErrorAdvice.h"
#include "program/Messages.h"

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <ctime>
#include <string_view>

namespace fenestra::core {
namespace {

std::atomic<std::atomic<bool>*> stopFlag = nullptr;
std::atomic<int> firstSignal = 0;
std::atomic<std::int64_t> firstTime = 0; ///< time of the first signal, ms
static_assert(std::atomic<std::atomic<bool>*>::is_always_lock_free);

std::int64_t readMilliseconds() {
  timespec now = {};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return std::int64_t{now.tv_sec} * 1000 + now.tv_nsec / 1'000'000;
}

/// True shortly after the first signal, since a closed terminal sends HUP twice.
bool isRepeat() {
  constexpr std::int64_t maxDelay = 300; // ms
  return readMilliseconds() - firstTime < maxDelay;
}

/// Writes the line to standard error, only on the first call by any thread.
void printOnce(std::string_view line) {
  static std::atomic<bool> isSaid = false;
  if (isSaid.exchange(true))
    return;
  for (const std::string_view text : {barEraser(), line})
    writeToStandardError(text);
}

/// Async-signal-safe.
void endNow() {
  if (firstSignal == SIGPIPE && isClosedOutputAllowed())
    ; // its reader has seen enough
  else if (firstSignal == SIGPIPE)
    printOnce("fenestra: standard output was closed\n");
  else if (hasPlacedResults())
    printOnce("fenestra: stopped on request\n");
  else
    printOnce("fenestra: stopped on request; nothing was written\n");
  removeAllTempFiles();
  std::_Exit(stopStatus());
}

void onSignal(int signal) {
  const int before = errno;
  std::atomic<bool>* const stop = stopFlag;
  if (firstSignal == 0) {
    firstTime = readMilliseconds();
    firstSignal = signal;
    if (stop)
      *stop = true;
    else
      endWhenUnblocked(endNow);
  } else if (!stop || !isRepeat()) {
    endWhenUnblocked(endNow);
  }
  errno = before;
}

} // namespace

void installStopHandlers() {
  ::signal(SIGXFSZ, SIG_IGN); // write() then returns an error, as for a full disk
  handleSignals({SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGXCPU, SIGPIPE}, onSignal);
}

bool isStopRequested() {
  return firstSignal != 0;
}

int stopStatus() {
  if (firstSignal != SIGPIPE)
    return stoppedStatus;
  return isClosedOutputAllowed() ? 0 : exitStatus(ErrorKind::output);
}

void endProcess(int status) {
  static std::atomic<int> last;
  last = status;
  endWhenUnblocked([] {
    removeAllTempFiles();
    std::_Exit(last);
  });
  waitForEnd();
}

DeferredStop::DeferredStop(std::atomic<bool>& stop) {
  stopFlag = &stop;
  if (firstSignal != 0)
    stop = true;
}

DeferredStop::~DeferredStop() {
  stopFlag = nullptr;
}

} // namespace fenestra::core
