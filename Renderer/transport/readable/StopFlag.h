#pragma once
// How work under way learns that nobody wants it any more.

#include <atomic>
#include <cstdint>

namespace fenestra {

/// Once true it stays so until the work has ended: what it left unfinished is dropped whole.
using StopFlag = std::atomic<bool>;

/// For work that has bounds of its own.
inline const StopFlag neverStopped = false;

/// Steps of one walk between two looks at the flag: a fraction of a millisecond, where asking each
/// time would cost as much as a step.
inline constexpr std::uint32_t stepsBetweenLooks = 1024;

} // namespace fenestra
