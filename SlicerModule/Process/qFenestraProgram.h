#pragma once
// The renderer as a child process. It does not load Slicer's libraries and never outlives Slicer,
// even if Slicer crashes.

#include <QProcess>
#include <QProcessEnvironment>

/// How a child process ended.
struct qFenestraOutcome {
  /// `stopped`: on request, with the results so far; `killed`: on request, without results.
  enum class Kind { done, stopped, killed, failed };
  Kind kind = Kind::done;
  QString message; ///< one sentence with advice; empty: no failure
  QString details; ///< the renderer's own messages
};

class qFenestraProgram : public QProcess {
  Q_OBJECT

public:
  explicit qFenestraProgram(QObject* parent = nullptr);
  /// Stops the child and waits for its end, so that no zombie process remains.
  ~qFenestraProgram() override;

  /// Starts `program` in `folder`; `ended` is emitted even if the start fails.
  void run(const QString& program, const QStringList& arguments, const QString& folder);

  /// Requests the end of the child, which first writes its finished results, without a time limit.
  /// A second call kills the child.
  void stop();

  /// Removes the variables by which Slicer's launcher selects its own libraries and plugins.
  static QProcessEnvironment removeLibraryPaths(QProcessEnvironment environment);

signals:
  /// One line of the child's standard output, without its line end.
  void lineReceived(const QString& line);
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
