#pragma once
// Tells a person or Slicer how far a render is, from a thread of its own.

#include "base/Stopwatch.h"
#include "program/RenderFlags.h"

#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace fenestra {

/// Pictures that are rendered one after the other.
struct FrameCount {
  int finished = 0; ///< before these
  int all = 1;
};

/// Shows progress from construction to destruction: a bar on standard error, which goes away at the
/// end, or Slicer's tags on standard output. `automatic` is a bar where standard error is a
/// terminal.
class Progress {
public:
  Progress(ProgressMode mode, const RenderSettings& settings, std::uint64_t pixels,
           const RenderMonitor& monitor, const FrameCount& frames = {});
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// A picture is finished; the monitor tells of the next one by now.
  void nextFrame();

private:
  void run();
  void show(bool last);
  void showTags(double done, bool last) const;
  void showBar(double done) const;
  /// Frames, samples and noise, in words.
  std::vector<std::string> reached() const;
  /// Of all that is to be done, in [0, 1].
  double fraction() const;
  /// Of a picture: the nearest to its end of samples, seconds and noise, in [0, 1].
  double frameFraction() const;

  ProgressMode m_mode;
  RenderSettings m_settings;
  double m_pixels;
  const RenderMonitor& m_monitor;
  FrameCount m_frames;
  int m_frame = 0; ///< finished since
  Stopwatch m_watch, m_frameWatch;
  std::mutex m_mutex;
  std::condition_variable m_wake;
  bool m_done = false;
  double m_fraction = 0.0; ///< shown last: noise can grow between passes, progress does not
  std::thread m_thread;
};

} // namespace fenestra
