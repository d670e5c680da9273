#pragma once
// Wall-clock time.

#include <chrono>

namespace fenestra {

class Stopwatch {
public:
  /// Time since construction or the last lap().
  double seconds() const { return since(Clock::now()); }

  /// Returns seconds() and restarts.
  double lap() {
    const Clock::time_point now = Clock::now();
    const double seconds = since(now);
    m_start = now;
    return seconds;
  }

private:
  using Clock = std::chrono::steady_clock;

  double since(Clock::time_point now) const {
    return std::chrono::duration<double>(now - m_start).count();
  }

  Clock::time_point m_start = Clock::now();
};

} // namespace fenestra
