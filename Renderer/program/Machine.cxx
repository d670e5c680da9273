#include "program/Machine.h"

#include "base/Error.h"
#include "transport/lanes/Tracker.h"

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstdlib>
#include <future>
#include <stdexcept>
#include <thread>
#include <vector>

namespace fenestra {
namespace {

int threadCount(const FlagValues& flags) {
  const int cores = tbb::info::default_concurrency();
  const auto wanted = static_cast<int>(flags.count("threads").value_or(0));
  return wanted > 0 ? std::min(wanted, cores) : cores;
}

/// Starts `count` threads at once, to find out whether they can run: TBB's threads start each
/// other, and end the process where one cannot start.
void tryThreads(int count) {
  std::vector<std::jthread> threads; // end as soon as the promise below is gone
  std::promise<void> started;
  const std::shared_future<void> all = started.get_future().share();
  for (int i = 0; i < count; ++i)
    threads.emplace_back([all] { all.wait(); });
}

} // namespace

void useMachine(const FlagValues& flags) {
  const int count = threadCount(flags);
  // Never destroyed: after its destruction TBB would start more than `count` threads.
  [[maybe_unused]] static const auto* const limit = new tbb::global_control(
      tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(count));
  try {
    tryThreads(count - 1);
    tbb::parallel_for(
        0, count, [](int) {}, tbb::simple_partitioner());
  } catch (const std::runtime_error&) { // std::system_error, and TBB's own errors
    throw outputError("threads", std::to_string(count) +
                                     " cannot be started; allow more processes (ulimit -u), or "
                                     "render with --threads 1");
  }
  if (const char* pinned = std::getenv("FENESTRA_INSTRUCTIONS"))
    WideTracker::useInstructionSet(pinned);
}

} // namespace fenestra
