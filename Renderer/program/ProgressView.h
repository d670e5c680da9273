#pragma once
// How progress is shown, to a person or to Slicer.

#include "base/Stopwatch.h"
#include "program/RenderOptions.h"

#include <string>
#include <vector>

namespace fenestra {

/// A bar on standard error, erased at the end, or Slicer's tags on standard output. `automatic`: a
/// bar if standard error is a terminal.
class ProgressView {
public:
  /// `comment`: what is done, for Slicer.
  ProgressView(ProgressMode mode, const char* comment);

  /// Never automatic.
  ProgressMode mode() const { return m_mode; }
  /// Shows the finished share of all the work, in [0, 1], never less than before, the time left,
  /// and texts on what is reached. `last`: for the last time.
  void show(double fraction, const std::vector<std::string>& status, bool last);
  /// Makes room for a line of text; the bar comes back with show.
  void erase() const;

private:
  void showTags(const std::vector<std::string>& status, bool last) const;
  void showBar(const std::vector<std::string>& status) const;

  ProgressMode m_mode;
  Stopwatch m_watch;
  double m_fraction = 0.0; ///< last shown
};

} // namespace fenestra
