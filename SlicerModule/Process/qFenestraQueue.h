#pragma once
// Renders that run one after the other, each a `fenestra` of its own.

#include "qFenestraProgram.h"

#include <QQueue>

/// What is to be rendered: arguments of `fenestra`, run in a folder.
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

  /// Starts the render, or lets it wait its turn.
  void add(const qFenestraJob& job);
  /// Ends the render under way, which keeps what it has (stopped again: not), or forgets the
  /// waiting one.
  void stop(int id);
  int waiting() const { return static_cast<int>(m_waiting.size()); }

  /// The part that is done, of a line that the renderer says; -1 where it says something else.
  static double progressIn(const QString& line);
  /// What it has reached, in words; empty where it says something else.
  static QString commentIn(const QString& line);

signals:
  void started(int id);
  void progressed(int id, double part);
  void commented(int id, const QString& reached);
  void ended(int id, const qFenestraOutcome& outcome);

private:
  void startNext();

  QString m_program;
  qFenestraProgram m_child;
  QQueue<qFenestraJob> m_waiting;
  int m_current = -1; ///< -1: none
};
