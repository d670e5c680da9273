#include "cli/Progress.h"

#include <cstdio>
#include <unistd.h>

namespace fenestra {
namespace {

std::string clock(double seconds) {
  if (!(seconds < 360000.0))
    return "--:--";
  const int s = static_cast<int>(seconds + 0.5);
  char text[32];
  if (s >= 3600)
    std::snprintf(text, sizeof text, "%d:%02d:%02d", s / 3600, s / 60 % 60, s % 60);
  else
    std::snprintf(text, sizeof text, "%d:%02d", s / 60, s % 60);
  return text;
}

std::string bar(double fraction) {
  constexpr int width = 24;
  const int full = static_cast<int>(fraction * width);
  return std::string(static_cast<std::size_t>(full), '#') +
         std::string(static_cast<std::size_t>(width - full), '.');
}

} // namespace

Progress::Progress(ProgressMode mode, const RenderSettings& settings, std::uint64_t pixels,
                   const RenderMonitor& monitor)
    : m_mode(mode),
      m_settings(settings),
      m_pixels(static_cast<double>(pixels)),
      m_monitor(monitor) {
  if (m_mode == ProgressMode::automatic)
    m_mode = ::isatty(STDERR_FILENO) ? ProgressMode::bar : ProgressMode::none;
  if (m_mode == ProgressMode::xml) {
    std::puts("<filter-start>\n<filter-name>fenestra</filter-name>\n"
              "<filter-comment>Path tracing</filter-comment>\n</filter-start>");
    std::fflush(stdout);
  }
  if (m_mode != ProgressMode::none)
    m_thread = std::thread([this] { run(); });
}

Progress::~Progress() {
  if (!m_thread.joinable())
    return;
  {
    const std::lock_guard lock(m_mutex);
    m_done = true;
  }
  m_wake.notify_one();
  m_thread.join();
}

void Progress::run() {
  std::unique_lock lock(m_mutex);
  while (!m_wake.wait_for(lock, std::chrono::milliseconds(100), [this] { return m_done; }))
    show(false);
  show(true);
}

double Progress::fraction(double seconds) const {
  const double paths = static_cast<double>(m_monitor.paths);
  double most = paths / (static_cast<double>(m_settings.samples) * m_pixels);
  most = std::max(most, seconds / m_settings.seconds);
  const double noise = m_monitor.noise;
  if (m_settings.noise > 0.0 && noise > 0.0) // variance falls as one over the samples
    most = std::max(most, std::pow(m_settings.noise / noise, 2.0));
  return std::clamp(most, 0.0, 1.0);
}

void Progress::show(bool last) const {
  const double seconds = m_watch.seconds();
  const double done = last && !m_monitor.stop ? 1.0 : fraction(seconds);
  if (m_mode == ProgressMode::xml) {
    std::printf("<filter-progress>%.4f</filter-progress>\n", done);
    if (last)
      std::printf("<filter-end>\n<filter-name>fenestra</filter-name>\n<filter-time>%.2f"
                  "</filter-time>\n</filter-end>\n",
                  seconds);
    std::fflush(stdout);
    return;
  }
  const double samples = static_cast<double>(m_monitor.paths) / m_pixels;
  const double noise = m_monitor.noise;
  char noiseText[32] = "";
  if (noise < infinity)
    std::snprintf(noiseText, sizeof noiseText, "  noise %.3f", noise);
  const double left = done > 0.0 ? seconds * (1.0 - done) / done : infinity;
  std::fprintf(stderr, "\r[%s] %3.0f %%  %.*f samples%s  %s  ETA %s \033[K", bar(done).c_str(),
               100.0 * done, samples < 10.0 ? 1 : 0, samples, noiseText, clock(seconds).c_str(),
               clock(left).c_str());
  if (last)
    std::fputc('\n', stderr);
  std::fflush(stderr);
}

} // namespace fenestra
