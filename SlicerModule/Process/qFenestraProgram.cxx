#include "qFenestraProgram.h"

#include <csignal>

#ifdef Q_OS_LINUX
#include <sys/prctl.h>
#endif

namespace {

/// Runs in the child between fork and exec. The kernel sends the signal when the parent ends, even
/// by a crash.
void endWithParent() {
#ifdef Q_OS_LINUX
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
#endif
}

/// Last line of the renderer's messages, without the program's name and "error", which older
/// programs omit.
QString findLastLine(const QString& text) {
  QString line = text.trimmed().section('\n', -1);
  for (const QString& start : {QStringLiteral("fenestra: "), QStringLiteral("error: ")})
    if (line.startsWith(start))
      line.remove(0, start.size());
  return line;
}

} // namespace

qFenestraProgram::qFenestraProgram(QObject* parent) : QProcess(parent) {
  setProcessEnvironment(removeLibraryPaths(QProcessEnvironment::systemEnvironment()));
#if QT_VERSION >= QT_VERSION_CHECK(6, 0, 0)
  setChildProcessModifier(endWithParent);
#endif
  connect(this, &QProcess::readyReadStandardOutput, this, &qFenestraProgram::readLines);
  connect(this, &QProcess::errorOccurred, this, [this](QProcess::ProcessError error) {
    if (error != QProcess::FailedToStart)
      return;
    const qFenestraOutcome outcome = {
        qFenestraOutcome::Kind::failed,
        tr("The renderer could not be started. Install the Fenestra extension again, or check the "
           "executable in the application settings."),
        QStringLiteral("%1: %2").arg(program(), errorString())};
    // Queued until after start(), since a receiver may start the program again.
    QMetaObject::invokeMethod(
        this, [this, outcome] { finish(outcome); }, Qt::QueuedConnection);
  });
  connect(this, QOverload<int, QProcess::ExitStatus>::of(&QProcess::finished), this,
          [this](int code, QProcess::ExitStatus status) {
            readLines();
            finish(makeOutcome(code, status));
          });
}

qFenestraProgram::~qFenestraProgram() {
  blockSignals(true); // not disconnected, since connections keep files alive until the child's end
  if (state() == QProcess::NotRunning)
    return;
  constexpr int graceMs = 200;
  terminate();
  if (!waitForFinished(graceMs)) {
    kill();
    waitForFinished();
  }
}

#if QT_VERSION < QT_VERSION_CHECK(6, 0, 0)
void qFenestraProgram::setupChildProcess() {
  endWithParent();
}
#endif

void qFenestraProgram::run(const QString& program, const QStringList& arguments,
                           const QString& folder) {
  m_stopped = m_killed = false;
  m_ended = false;
  setWorkingDirectory(folder);
  start(program, arguments);
}

void qFenestraProgram::stop() {
  if (state() == QProcess::NotRunning)
    return;
  m_killed = m_stopped;
  m_stopped = true;
  if (m_killed)
    kill();
  else
    terminate();
}

QProcessEnvironment qFenestraProgram::removeLibraryPaths(QProcessEnvironment environment) {
  for (const char* name : {"LD_LIBRARY_PATH", "LD_PRELOAD", "DYLD_LIBRARY_PATH", "PYTHONHOME",
                           "PYTHONPATH", "QT_PLUGIN_PATH", "ITK_AUTOLOAD_PATH"})
    environment.remove(name);
  return environment;
}

void qFenestraProgram::readLines() {
  setReadChannel(QProcess::StandardOutput);
  while (canReadLine())
    emit lineReceived(QString::fromUtf8(readLine()).trimmed());
}

void qFenestraProgram::finish(const qFenestraOutcome& outcome) {
  if (m_ended)
    return;
  m_ended = true;
  emit ended(outcome);
}

qFenestraOutcome qFenestraProgram::makeOutcome(int code, QProcess::ExitStatus status) {
  constexpr int stoppedOnRequest = 5; // the renderer's exit status
  using Kind = qFenestraOutcome::Kind;
  const QString errors = QString::fromUtf8(readAllStandardError());
  const bool crashed = status == QProcess::CrashExit; // `code` is the signal then
  if (m_killed && crashed)
    return {Kind::killed, {}, errors};
  // SIGTERM itself ends a renderer that does not handle signals yet.
  if (crashed ? m_stopped && code == SIGTERM : code == stoppedOnRequest)
    return {Kind::stopped, {}, errors};
  if (crashed)
    return {Kind::failed,
            tr("The renderer ended unexpectedly. If the computer ran out of memory, render a "
               "smaller image, or crop the volume."),
            errors};
  if (code != 0)
    return {Kind::failed, findLastLine(errors), errors};
  return {Kind::done, {}, errors};
}
