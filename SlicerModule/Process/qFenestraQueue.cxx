#include "qFenestraQueue.h"

#include <algorithm>

qFenestraQueue::qFenestraQueue(const QString& program, QObject* parent)
    : QObject(parent), m_program(program) {
  connect(&m_child, &qFenestraProgram::said, this, [this](const QString& line) {
    const double part = progressIn(line);
    if (part >= 0.0)
      emit progressed(m_current, part);
  });
  connect(&m_child, &qFenestraProgram::ended, this, [this](const qFenestraOutcome& outcome) {
    const int id = m_current;
    m_current = -1;
    emit ended(id, outcome);
    startNext();
  });
}

void qFenestraQueue::add(const qFenestraJob& job) {
  m_waiting.enqueue(job);
  startNext();
}

void qFenestraQueue::stop(int id) {
  if (id == m_current) {
    m_child.stop();
    return;
  }
  const auto job = std::find_if(m_waiting.begin(), m_waiting.end(),
                                [id](const qFenestraJob& waiting) { return waiting.id == id; });
  if (job == m_waiting.end())
    return;
  m_waiting.erase(job);
  emit ended(id, {qFenestraOutcome::Kind::stopped, {}, {}});
}

double qFenestraQueue::progressIn(const QString& line) {
  const QString begin = QStringLiteral("<filter-progress>");
  const QString end = QStringLiteral("</filter-progress>");
  if (!line.startsWith(begin) || !line.endsWith(end))
    return -1.0;
  bool isNumber = false;
  const double part =
      line.mid(begin.size(), line.size() - begin.size() - end.size()).toDouble(&isNumber);
  return isNumber && part >= 0.0 ? std::min(part, 1.0) : -1.0;
}

void qFenestraQueue::startNext() {
  if (m_current >= 0 || m_waiting.isEmpty())
    return;
  const qFenestraJob job = m_waiting.dequeue();
  m_current = job.id;
  emit started(job.id);
  m_child.run(m_program, job.arguments + QStringList{"--progress", "xml"}, job.folder);
}
