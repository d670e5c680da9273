#pragma once
// The renderer as a child process: it does not see Slicer's libraries, and never outlives Slicer,
// however Slicer ends.

#include <QProcess>
#include <QProcessEnvironment>

/// End of a child, in words for the caller.
struct qFenestraOutcome {
  /// `stopped`: on request, results so far kept; `killed`: on request, results lost.
  enum class Kind { done, stopped, killed, failed };
  Kind kind = Kind::done;
  QString message; ///< one sentence with advice; empty: no failure
  QString details; ///< the renderer's own messages
};

class qFenestraProgram : public QProcess {
  Q_OBJECT

public:
  explicit qFenestraProgram(QObject* parent = nullptr);
  /// Stops the child and waits for its end: leaves no zombie.
  ~qFenestraProgram() override;

  /// Starts `program` in `folder`. `ended` follows, also if the start fails.
  void run(const QString& program, const QStringList& arguments, const QString& folder);

  /// Asks the child to end; it first writes its finished results, however long that takes. A second
  /// call kills the child.
  void stop();

  /// `environment` without the variables that a launcher set for its own program's libraries.
  static QProcessEnvironment removeLibraryPaths(QProcessEnvironment environment);

signals:
  /// One line of the child's standard output, without its line end.
  void said(const QString& line);
  void ended(const qFenestraOutcome& outcome);

protected:
#if QT_VERSION < QT_VERSION_CHECK(6, 0, 0)
  void setupChildProcess() override;
#endif

private:
  void readLines();
  void finish(const qFenestraOutcome& outcome);
  qFenestraOutcome makeOutcome(int code, QProcess::ExitStatus status);

  bool m_stopped = false, m_killed = false;
  bool m_ended = true;
};
