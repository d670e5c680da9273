#include "program/ProgressView.h"

#include "io/platform/Streams.h"
#include "program/Messages.h"

#include <algorithm>
#include <cstdio>

namespace fenestra::core {
namespace {

std::string formatTime(double seconds) {
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

std::string drawBar(double fraction, std::size_t width) {
  const auto full = static_cast<std::size_t>(fraction * static_cast<double>(width));
  return std::string("[") + std::string(full, '#') + std::string(width - full, '.') + "] ";
}

} // namespace

ProgressView::ProgressView(ProgressMode mode, const char* comment) : m_mode(mode) {
  if (m_mode == ProgressMode::automatic)
    m_mode = isStandardErrorTerminal() ? ProgressMode::bar : ProgressMode::none;
  if (m_mode != ProgressMode::xml)
    return;
  std::printf("<filter-start>\n<filter-name>fenestra</filter-name>\n"
              "<filter-comment>%s</filter-comment>\n</filter-start>\n",
              comment);
  std::fflush(stdout);
}

void ProgressView::show(double fraction, const std::vector<std::string>& status, bool last) {
  m_fraction = std::max(m_fraction, fraction); // noise can grow between passes
  if (m_mode == ProgressMode::xml)
    return showTags(status, last);
  if (m_mode != ProgressMode::bar)
    return;
  if (last)
    eraseBar();
  else
    showBar(drawLine(status));
}

void ProgressView::showTags(const std::vector<std::string>& status, bool last) const {
  std::printf("<filter-progress>%.4f</filter-progress>\n<filter-comment>%s</filter-comment>\n",
              m_fraction, join(status, ", ").c_str());
  if (last)
    std::printf("<filter-end>\n<filter-name>fenestra</filter-name>\n<filter-time>%.2f"
                "</filter-time>\n</filter-end>\n",
                m_watch.seconds());
  std::fflush(stdout);
}

std::string ProgressView::drawLine(const std::vector<std::string>& status) const {
  const double done = m_fraction;
  const double left = done > 0.0 ? m_watch.seconds() * (1.0 - done) / done : infinity;
  char percent[16];
  std::snprintf(percent, sizeof percent, "%3.0f %%", 100.0 * done);
  std::vector<std::string> fields = status;
  fields.insert(fields.begin(), {percent, formatTime(left) + " left"});

  // A wrapped line cannot be erased, so fields that do not fit are omitted, the bar first.
  constexpr std::size_t longest = 24; // of the bar
  constexpr std::size_t frame = 3;    // "[", "]" and a blank
  const std::size_t width = queryTerminalWidth() - 1;
  std::string line;
  for (const std::string& field : fields)
    if (line.size() + 2 + field.size() <= width)
      line += (line.empty() ? "" : "  ") + field;
  if (line.size() + frame + longest / 3 <= width)
    line = drawBar(done, std::min(longest, width - line.size() - frame)) + line;
  return line;
}

} // namespace fenestra::core
