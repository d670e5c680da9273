#pragma once
// Progress of a render, reported to a person or to Slicer from a separate thread.

#include "base/Stopwatch.h"
#include "program/RenderFlags.h"

#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace fenestra {

/// Count of the pictures that a command renders one after the other.
struct FrameCount {
  int finished = 0; ///< by earlier runs
  int all = 1;
};

/// Shows progress from construction to destruction: a bar on standard error, erased at the end, or
/// Slicer's tags on standard output. `automatic`: a bar if standard error is a terminal.
class Progress {
public:
  Progress(ProgressMode mode, const RenderSettings& settings, std::uint64_t pixels,
           const RenderMonitor& monitor, const FrameCount& frames = {});
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Counts a picture as finished. Call after resetting the monitor for the next picture.
  void nextFrame();

private:
  void run();
  void show(bool last);
  void showTags(double done, bool last) const;
  void showBar(double done) const;
  /// Texts of frame, samples a pixel and noise.
  std::vector<std::string> reached() const;
  /// Finished share of all the work, in [0, 1].
  double fraction() const;
  /// Finished share of the current picture, in [0, 1]: the largest of those by samples, seconds and
  /// noise.
  double frameFraction() const;

  ProgressMode m_mode;
  RenderSettings m_settings;
  double m_pixels;
  const RenderMonitor& m_monitor;
  FrameCount m_frames;
  int m_frame = 0; ///< frames finished since construction
  Stopwatch m_watch, m_frameWatch;
  std::mutex m_mutex;
  std::condition_variable m_wake;
  bool m_done = false;
  double m_fraction = 0.0; ///< last shown; never decreases, although noise can grow between passes
  std::thread m_thread;
};

} // namespace fenestra
