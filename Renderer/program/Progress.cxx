#include "program/Progress.h"

#include "scene/FinishedImage.h"

#include <cstdio>
#include <system_error>

namespace fenestra::core {
namespace {

std::string formatNumber(const char* format, double value) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

} // namespace

Progress::Progress(const RenderOptions& options, const RenderSettings& settings,
                   RenderMonitor& monitor, int finishedBefore, int frames)
    : m_view(options.progress, "Path tracing"),
      m_settings(settings),
      m_pixels(1.0 * options.scene.width * options.scene.height / settings.shard.count),
      m_monitor(monitor),
      m_finishedBefore(finishedBefore),
      m_finished(finishedBefore),
      m_frames(frames) {
  if (m_view.mode() == ProgressMode::none)
    return;
  m_monitor.isNoiseWanted = true;
  try {
    m_thread = std::jthread([this](const std::stop_token& end) { run(end); });
  } catch (const std::system_error&) { // no thread is available; render without progress
  }
}

void Progress::nextFrame() {
  const std::lock_guard lock(m_mutex);
  ++m_finished;
  m_frameWatch = Stopwatch();
  m_monitor.paths = 0;
  m_monitor.noise = infinity;
}

void Progress::run(const std::stop_token& end) {
  std::unique_lock lock(m_mutex);
  for (bool last = false; !last;) {
    m_wake.wait_for(lock, end, std::chrono::milliseconds(100), [] { return false; });
    last = end.stop_requested();
    show(last);
  }
}

double Progress::fraction() const {
  const double total = m_frames - m_finishedBefore, done = m_finished - m_finishedBefore;
  return total > 0.0 ? std::min(1.0, (done + frameFraction()) / total) : 1.0;
}

double Progress::frameFraction() const {
  return estimateFraction(m_monitor, m_settings, m_pixels, m_frameWatch.seconds());
}

void Progress::show(bool last) {
  m_view.show(last && !m_monitor.stop ? 1.0 : fraction(), statusFields(), last);
}

std::vector<std::string> Progress::statusFields() const {
  const double samples = static_cast<double>(m_monitor.paths) / m_pixels;
  const double noise = m_monitor.noise;
  std::vector<std::string> fields;
  if (m_frames > 1)
    fields.push_back(concat("frame ", std::min(m_finished + 1, m_frames), " of ", m_frames));
  fields.push_back(
      formatNumber(samples < 10.0 ? "%.1f samples per pixel" : "%.0f samples per pixel", samples));
  if (noise < infinity)
    fields.push_back(formatNumber("noise %.3f", noise));
  return fields;
}

} // namespace fenestra::core
