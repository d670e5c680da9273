#pragma once
// Queue of renders, run one after the other; each is a `fenestra` process.

#include "qFenestraProgram.h"

#include <QQueue>

/// Job of the queue: arguments of `fenestra`, run in a folder.
struct qFenestraJob {
  int id = 0;
  QStringList arguments;
  QString folder;
};

class qFenestraQueue : public QObject {
  Q_OBJECT

public:
  /// `program`: the renderer's path.
  explicit qFenestraQueue(const QString& program, QObject* parent = nullptr);
  /// Starts another program from the next render on.
  void setProgram(const QString& program) { m_program = program; }

  /// Starts the render, or queues it.
  void add(const qFenestraJob& job);
  /// Stops the current render and keeps finished results (a second call discards them), or removes
  /// a waiting one.
  void stop(int id);
  int waiting() const { return static_cast<int>(m_waiting.size()); }

  /// Finished fraction in a line of the renderer's output, 0 to 1; -1: another kind of line.
  static double parseProgress(const QString& line);
  /// Samples and noise in a line of the renderer's output; empty: another kind of line.
  static QString parseComment(const QString& line);

signals:
  void started(int id);
  void progressed(int id, double fraction);
  void commented(int id, const QString& status);
  void ended(int id, const qFenestraOutcome& outcome);

private:
  void startNext();

  QString m_program;
  qFenestraProgram m_child;
  QQueue<qFenestraJob> m_waiting;
  int m_current = -1; ///< -1: none
};
