#pragma once
// Progress of a render, reported to a terminal or to Slicer from a separate thread.

#include "base/Stopwatch.h"
#include "program/ProgressView.h"

#include <condition_variable>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

namespace fenestra::core {

/// Shows progress from construction to destruction.
class Progress {
public:
  /// For a command that renders `frames` images in sequence, of which earlier runs finished
  /// `finishedBefore`.
  Progress(const RenderOptions& options, const RenderSettings& settings, RenderMonitor& monitor,
           int finishedBefore = 0, int frames = 1);

  /// Counts the image as finished, and resets the monitor for the next one.
  void nextFrame();

private:
  void run(const std::stop_token& end);
  void show(bool last);
  /// Frame number, samples per pixel and noise as text.
  std::vector<std::string> statusFields() const;
  /// Finished fraction of all work, in [0, 1].
  double fraction() const;
  /// Finished fraction of the current image, in [0, 1], by samples, seconds or noise.
  double frameFraction() const;

  ProgressView m_view;
  RenderSettings m_settings;
  double m_pixels;
  RenderMonitor& m_monitor;
  int m_finishedBefore, m_finished,
      m_frames; ///< frames: finished by earlier runs, finished so far, total
  Stopwatch m_frameWatch;
  std::mutex m_mutex;
  std::condition_variable_any m_wake;
  std::jthread m_thread; ///< ends before the members above
};

} // namespace fenestra::core
