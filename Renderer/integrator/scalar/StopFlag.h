#pragma once
// A flag that cancels work under way.

#include <atomic>
#include <cstdint>

namespace fenestra {

/// Stays true, once set, until the work has ended; unfinished parts are dropped whole.
using StopFlag = std::atomic<bool>;

/// Flag for work that is bounded anyway.
inline const StopFlag neverStopped = false;

/// Steps of a walk between two reads of the flag: a fraction of a millisecond. A read at each step
/// would cost as much as the step.
inline constexpr std::uint32_t stopPollInterval = 1024;

} // namespace fenestra
