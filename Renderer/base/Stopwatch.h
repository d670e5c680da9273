#pragma once
// Wall-clock time.

#include <chrono>
#include <utility>

namespace fenestra::core {

class Stopwatch {
public:
  /// Time since construction or the last lap().
  double seconds() const { return Seconds(Clock::now() - m_start).count(); }

  /// Returns seconds() and restarts.
  double lap() {
    const Clock::time_point before = std::exchange(m_start, Clock::now());
    return Seconds(m_start - before).count();
  }

private:
  using Clock = std::chrono::steady_clock;
  using Seconds = std::chrono::duration<double>;

  Clock::time_point m_start = Clock::now();
};

} // namespace fenestra::core
