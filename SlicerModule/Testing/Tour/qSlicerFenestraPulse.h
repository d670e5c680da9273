#pragma once

#include <QElapsedTimer>
#include <QTimer>

/// Measures the longest time during which the event loop did not respond.
class qSlicerFenestraPulse {
public:
  qSlicerFenestraPulse();
  void start() { m_longest = 0, m_watch.start(); }
  int longest() const { return static_cast<int>(m_longest); } ///< milliseconds

private:
  QTimer m_timer;
  QElapsedTimer m_watch;
  qint64 m_longest = 0;
};
