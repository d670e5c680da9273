// Use of the machine's cores and instruction sets.

#include "base/Error.h"
#include "base/InstructionSets.h"
#include "program/Commands.h"
#include "program/Options.h"

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <stdexcept>
#include <stop_token>
#include <thread>
#include <vector>

namespace fenestra::core {
namespace {

/// Starts `count` threads at the same time, to check that they can run: TBB's threads start each
/// other, and end the process if one cannot start.
void tryThreads(int count) {
  // The destructors stop and join all threads, also if one could not start.
  std::vector<std::jthread> threads;
  for (int i = 0; i < count; ++i)
    threads.emplace_back([](const std::stop_token& end) {
      std::atomic_flag isEnded;
      const std::stop_callback onEnd(end, [&isEnded] {
        isEnded.test_and_set();
        isEnded.notify_one();
      });
      isEnded.wait(false);
    });
}

} // namespace

void pinInstructions() {
  if (const char* pinned = std::getenv("FENESTRA_INSTRUCTIONS"))
    useInstructionSet(pinned);
}

int threadCount(const OptionValues& options) {
  const int cores = tbb::info::default_concurrency();
  const auto wanted = static_cast<int>(options.integer("threads").value_or(0));
  return wanted > 0 ? std::min(wanted, cores) : cores;
}

void configureMachine(const OptionValues& options) {
  const int count = threadCount(options);
  // Never destroyed: without it TBB would start more than `count` threads.
  [[maybe_unused]] static const auto* const limit = new tbb::global_control(
      tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(count));
  try {
    tryThreads(count - 1);
    tbb::parallel_for(
        0, count, [](int) {}, tbb::simple_partitioner());
  } catch (const std::runtime_error&) { // std::system_error, and TBB's own errors
    throw outputError("threads", count,
                      " cannot be started; allow more processes (ulimit -u), or "
                      "use --threads 1");
  }
  pinInstructions();
}

} // namespace fenestra::core
