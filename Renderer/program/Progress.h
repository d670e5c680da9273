#pragma once
// Progress of a render, reported to a person or to Slicer from a separate thread.

#include "base/Stopwatch.h"
#include "program/ProgressView.h"

#include <condition_variable>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

namespace fenestra {

/// Shows progress from construction to destruction.
class Progress {
public:
  /// For a command that renders `frames` pictures one after the other, `before` of them by earlier
  /// runs.
  Progress(const RenderOptions& options, RenderMonitor& monitor, int finishedBefore = 0,
           int frames = 1);

  /// Counts a picture as finished, and resets the monitor for the next one.
  void nextFrame();

private:
  void run(const std::stop_token& end);
  void show(bool last);
  /// Texts of frame, samples a pixel and noise.
  std::vector<std::string> statusFields() const;
  /// Finished share of all the work, in [0, 1].
  double fraction() const;
  /// Finished share of the current picture, in [0, 1], by samples, seconds or noise.
  double frameFraction() const;

  ProgressView m_view;
  RenderSettings m_settings;
  double m_pixels;
  RenderMonitor& m_monitor;
  int m_finishedBefore, m_finished,
      m_frames; ///< frames: by earlier runs, so far (these included), all
  Stopwatch m_frameWatch;
  std::mutex m_mutex;
  std::condition_variable_any m_wake;
  std::jthread m_thread; ///< ends before the members above
};

} // namespace fenestra
