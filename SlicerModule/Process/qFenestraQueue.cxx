#include "qFenestraQueue.h"

#include <algorithm>

namespace {

/// Text within one of Slicer's progress tags that fills the line; empty for other lines.
QString extractTag(const QString& line, const char* tag) {
  const QString begin = QStringLiteral("<filter-%1>").arg(tag);
  const QString end = QStringLiteral("</filter-%1>").arg(tag);
  if (!line.startsWith(begin) || !line.endsWith(end))
    return {};
  return line.mid(begin.size(), line.size() - begin.size() - end.size());
}

} // namespace

qFenestraQueue::qFenestraQueue(const QString& program, QObject* parent)
    : QObject(parent), m_program(program) {
  connect(&m_child, &qFenestraProgram::lineReceived, this, [this](const QString& line) {
    const double fraction = parseProgress(line);
    if (fraction >= 0.0)
      emit progressed(m_current, fraction);
    const QString comment = parseComment(line);
    if (!comment.isEmpty())
      emit commented(m_current, comment);
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

double qFenestraQueue::parseProgress(const QString& line) {
  bool isNumber = false;
  const double fraction = extractTag(line, "progress").toDouble(&isNumber);
  return isNumber && fraction >= 0.0 ? std::min(fraction, 1.0) : -1.0;
}

QString qFenestraQueue::parseComment(const QString& line) {
  return extractTag(line, "comment");
}

void qFenestraQueue::startNext() {
  if (m_current >= 0 || m_waiting.isEmpty())
    return;
  const qFenestraJob job = m_waiting.dequeue();
  m_current = job.id;
  emit started(job.id);
  m_child.run(m_program, job.arguments + QStringList{"--progress", "xml"}, job.folder);
}
