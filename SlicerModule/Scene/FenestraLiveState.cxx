#include "FenestraLiveState.h"

#include <algorithm>

namespace SlicerExport {

void LiveState::turnOn(double now) {
  if (!isOn())
    moveCamera(now - restSeconds); // it rests already
}

void LiveState::turnOff() {
  *this = {};
}

bool LiveState::moveCamera(double now) {
  const bool hasRested = isOn() && m_phase != Phase::turning;
  m_phase = Phase::turning;
  m_requestTime = now + restSeconds;
  m_shownTime = -never;
  m_hasImage = false;
  return hasRested;
}

void LiveState::change(double now) {
  if (m_phase == Phase::off || m_phase == Phase::turning)
    return;
  m_requestTime = now;
  m_hasImage = false;
}

void LiveState::receive(bool isLast) {
  if (m_phase == Phase::off || m_phase == Phase::turning)
    return; // of an earlier camera
  m_hasImage = true;
  m_isLast = isLast;
}

bool LiveState::takeRequest(double now) {
  if (now < m_requestTime)
    return false;
  m_requestTime = never;
  m_phase = Phase::waiting;
  return true;
}

bool LiveState::takeImage(double now) {
  if (!m_hasImage || now < m_shownTime + refreshSeconds)
    return false;
  m_hasImage = false;
  m_shownTime = now;
  m_phase = m_isLast ? Phase::done : Phase::refining;
  return true;
}

double LiveState::nextTime() const {
  return std::min(m_requestTime, m_hasImage ? m_shownTime + refreshSeconds : never);
}

} // namespace SlicerExport
