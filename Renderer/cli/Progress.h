#pragma once
// Tells a person or Slicer how far a render is, from a thread of its own.

#include "cli/RenderFlags.h"
#include "core/Stopwatch.h"

#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace fenestra {

/// Shows progress from construction to destruction: a bar on standard error, which goes away at the
/// end, or Slicer's tags on standard output. `automatic` is a bar where standard error is a
/// terminal.
class Progress {
public:
  Progress(ProgressMode mode, const RenderSettings& settings, std::uint64_t pixels,
           const RenderMonitor& monitor);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

private:
  void run();
  void show(bool last);
  void showTags(double done, bool last) const;
  void showBar(double done) const;
  /// Samples and noise, in words.
  std::vector<std::string> reached() const;
  /// The nearest to its end of samples, seconds and noise, in [0, 1].
  double fraction(double seconds) const;

  ProgressMode m_mode;
  RenderSettings m_settings;
  double m_pixels;
  const RenderMonitor& m_monitor;
  Stopwatch m_watch;
  std::mutex m_mutex;
  std::condition_variable m_wake;
  bool m_done = false;
  double m_fraction = 0.0; ///< shown last: noise can grow between passes, progress does not
  std::thread m_thread;
};

} // namespace fenestra
