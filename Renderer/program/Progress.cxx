#include "program/Progress.h"

#include <cstdio>
#include <sys/ioctl.h>
#include <system_error>
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

std::string formatted(const char* format, double value) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::string bar(double fraction, std::size_t width) {
  const auto full = static_cast<std::size_t>(fraction * static_cast<double>(width));
  return std::string("[") + std::string(full, '#') + std::string(width - full, '.') + "] ";
}

/// Width of the terminal in characters, queried each time: a user may change it.
std::size_t columns() {
  winsize size = {};
  const bool known = ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return known ? size.ws_col : 80;
}

} // namespace

Progress::Progress(const RenderOptions& options, RenderMonitor& monitor, int before, int frames)
    : m_mode(options.progress),
      m_settings(options.settings),
      m_pixels(1.0 * options.scene.width * options.scene.height / options.settings.shard.count),
      m_monitor(monitor),
      m_before(before),
      m_finished(before),
      m_frames(frames) {
  if (m_mode == ProgressMode::automatic)
    m_mode = ::isatty(STDERR_FILENO) ? ProgressMode::bar : ProgressMode::none;
  if (m_mode == ProgressMode::xml) {
    std::puts("<filter-start>\n<filter-name>fenestra</filter-name>\n"
              "<filter-comment>Path tracing</filter-comment>\n</filter-start>");
    std::fflush(stdout);
  }
  if (m_mode == ProgressMode::none)
    return;
  try {
    m_thread = std::jthread([this](const std::stop_token& end) { run(end); });
  } catch (const std::system_error&) { // no thread is left; the picture matters more
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
  const double toDo = m_frames - m_before, done = m_finished - m_before;
  return toDo > 0.0 ? std::min(1.0, (done + frameFraction()) / toDo) : 1.0;
}

double Progress::frameFraction() const {
  const double paths = static_cast<double>(m_monitor.paths);
  double most = std::max(paths / (static_cast<double>(m_settings.samples) * m_pixels),
                         m_frameWatch.seconds() / m_settings.seconds);
  const double noise = m_monitor.noise;
  if (m_settings.noise > 0.0 && noise > 0.0) // variance is proportional to 1 / samples
    most = std::max(most, std::pow(m_settings.noise / noise, 2.0));
  return std::clamp(most, 0.0, 1.0);
}

void Progress::show(bool last) {
  const double now = last && !m_monitor.stop ? 1.0 : fraction();
  m_fraction = std::max(m_fraction, now);
  if (m_mode == ProgressMode::xml)
    return showTags(last);
  if (last)
    std::fputs("\r\033[K", stderr); // leaves an empty line for the final report
  else
    showBar();
  std::fflush(stderr);
}

void Progress::showTags(bool last) const {
  const std::string comment = joined(reached(), ", ");
  std::printf("<filter-progress>%.4f</filter-progress>\n<filter-comment>%s</filter-comment>\n",
              m_fraction, comment.c_str());
  if (last)
    std::printf("<filter-end>\n<filter-name>fenestra</filter-name>\n<filter-time>%.2f"
                "</filter-time>\n</filter-end>\n",
                m_watch.seconds());
  std::fflush(stdout);
}

std::vector<std::string> Progress::reached() const {
  const double samples = static_cast<double>(m_monitor.paths) / m_pixels;
  const double noise = m_monitor.noise;
  std::vector<std::string> fields;
  if (m_frames > 1)
    fields.push_back(textOf("frame ", std::min(m_finished + 1, m_frames), " of ", m_frames));
  fields.push_back(
      formatted(samples < 10.0 ? "%.1f samples a pixel" : "%.0f samples a pixel", samples));
  if (noise < infinity)
    fields.push_back(formatted("noise %.3f", noise));
  return fields;
}

void Progress::showBar() const {
  const double done = m_fraction;
  const double left = done > 0.0 ? m_watch.seconds() * (1.0 - done) / done : infinity;
  std::vector<std::string> fields = reached();
  fields.insert(fields.begin(), {formatted("%3.0f %%", 100.0 * done), clock(left) + " left"});

  // A wrapped line cannot be erased: fields that do not fit are left out, the bar first.
  constexpr std::size_t longest = 24;
  constexpr std::size_t frame = 3;
  const std::size_t width = columns() - 1;
  std::string line;
  for (const std::string& field : fields)
    if (line.size() + 2 + field.size() <= width)
      line += (line.empty() ? "" : "  ") + field;
  if (line.size() + frame + longest / 3 <= width)
    line = bar(done, std::min(longest, width - line.size() - frame)) + line;
  std::fprintf(stderr, "\r%s\033[K", line.c_str());
}

} // namespace fenestra
