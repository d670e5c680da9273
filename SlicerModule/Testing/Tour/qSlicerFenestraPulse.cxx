#include "qSlicerFenestraPulse.h"

#include <algorithm>

qSlicerFenestraPulse::qSlicerFenestraPulse() {
  m_watch.start();
  constexpr int interval = 5;
  QObject::connect(&m_timer, &QTimer::timeout,
                   [this] { m_longest = std::max(m_longest, m_watch.restart() - interval); });
  m_timer.setTimerType(Qt::PreciseTimer);
  m_timer.start(interval);
}
