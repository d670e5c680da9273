#pragma once
// Display of progress on a terminal or in Slicer.

#include "base/Stopwatch.h"
#include "program/RenderOptions.h"

#include <string>
#include <vector>

namespace fenestra::core {

/// A bar on standard error, erased at the end, or Slicer's progress tags on standard output.
/// `automatic`: a bar if standard error is a terminal.
class ProgressView {
public:
  /// `comment`: name of the task, for Slicer.
  ProgressView(ProgressMode mode, const char* comment);

  /// Never automatic.
  ProgressMode mode() const { return m_mode; }
  /// Shows the finished fraction of all work, in [0, 1], which never decreases; the time left; and
  /// status texts. `last`: final call.
  void show(double fraction, const std::vector<std::string>& status, bool last);

private:
  void showTags(const std::vector<std::string>& status, bool last) const;
  /// Bar, percentage, time left and status, as far as they fit into the terminal's width.
  std::string drawLine(const std::vector<std::string>& status) const;

  ProgressMode m_mode;
  Stopwatch m_watch;
  double m_fraction = 0.0; ///< last shown
};

} // namespace fenestra::core
