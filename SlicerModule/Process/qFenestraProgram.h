#pragma once
// The renderer as a child process. It does not see the libraries that Slicer brings, and it never
// outlives Slicer, however that ends.

#include <QProcess>
#include <QProcessEnvironment>

/// How a child ended, in words for who started it.
struct qFenestraOutcome {
  /// `stopped`: at the user's word, with what it had; `killed`: without.
  enum class Kind { done, stopped, killed, failed };
  Kind kind = Kind::done;
  QString message; ///< one sentence that says what to do; empty where nothing failed
  QString details; ///< what the renderer itself said
};

class qFenestraProgram : public QProcess {
  Q_OBJECT

public:
  explicit qFenestraProgram(QObject* parent = nullptr);
  /// Stops the child and waits for it: no zombie is left.
  ~qFenestraProgram() override;

  /// Starts `program` in `folder`. `ended` follows, also where it cannot be started.
  void run(const QString& program, const QStringList& arguments, const QString& folder);

  /// Asks the child to end, which writes what it has finished, however long that takes. Asked
  /// again, kills it.
  void stop();

  /// An environment without what a launcher set for its own program's libraries.
  static QProcessEnvironment isolated(QProcessEnvironment environment);

signals:
  /// A line of the child's standard output, without its end.
  void said(const QString& line);
  void ended(const qFenestraOutcome& outcome);

protected:
#if QT_VERSION < QT_VERSION_CHECK(6, 0, 0)
  void setupChildProcess() override;
#endif

private:
  void readLines();
  void finish(const qFenestraOutcome& outcome);
  qFenestraOutcome outcomeOf(int code, QProcess::ExitStatus status);

  bool m_stopped = false, m_killed = false;
  bool m_ended = true;
};
