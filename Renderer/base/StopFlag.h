#pragma once
// A flag that cancels running work.

#include <atomic>
#include <cstdint>

namespace fenestra::core {

/// Once set, stays true until the work has ended. Unfinished tiles are discarded.
using StopFlag = std::atomic<bool>;

/// For work of bounded duration.
inline const StopFlag neverStopped = false;

/// Tracking steps per poll of the stop flag: a fraction of a millisecond. Polling at each step
/// would cost as much as the step.
inline constexpr std::uint32_t stopPollInterval = 1024;

} // namespace fenestra::core
