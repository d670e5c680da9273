#include "cli/Machine.h"

#include "tracking/WideTracker.h"

#include <tbb/info.h>

#include <cstdlib>

namespace fenestra {
namespace {

std::size_t threadCount(const RenderSettings& settings) {
  const auto cores = static_cast<std::size_t>(tbb::info::default_concurrency());
  return settings.threads > 0 ? std::min(static_cast<std::size_t>(settings.threads), cores) : cores;
}

} // namespace

MachineUse::MachineUse(const RenderSettings& settings)
    : m_threads(tbb::global_control::max_allowed_parallelism, threadCount(settings)) {
  if (const char* pinned = std::getenv("FENESTRA_INSTRUCTIONS"))
    WideTracker::useInstructionSet(pinned);
}

} // namespace fenestra
