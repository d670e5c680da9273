#pragma once
// Preview that follows the user's changes: sends them to a `fenestra serve` after a short rest, and
// receives its pictures as they improve.

#include "qFenestraProgram.h"

#include <QJsonObject>
#include <QTimer>

#include <map>
#include <memory>
#include <string>

struct qFenestraPreviewImage {
  QStringList files;
  int samples = 0;      ///< samples a pixel
  double noise = -1.0;  ///< relative noise; negative: not known yet
  double seconds = 0.0; ///< time since the change
  bool done = false;    ///< last picture of the change
};

class qFenestraPreview : public QObject {
  Q_OBJECT

public:
  explicit qFenestraPreview(QObject* parent = nullptr);

  /// Milliseconds without another change before changes are sent.
  void setDelay(int milliseconds) { m_delay.setInterval(milliseconds); }

  /// Starts `fenestra serve arguments…`, and ends the preview under way. `files` are kept until the
  /// child has ended, also after stop().
  void start(const QString& program, const QStringList& arguments, const QString& folder,
             const std::shared_ptr<const void>& files = {});
  /// Returns at once: the child ends by itself, at the latest with this object, and its further
  /// output is ignored.
  void stop();
  bool running() const { return m_child && m_child->state() != QProcess::NotRunning; }
  /// Folder to which the picture's files are relative.
  QString folder() const { return m_child ? m_child->workingDirectory() : QString(); }

  /// Changes flags, with values as `fenestra serve` takes them; later values win.
  void change(const QJsonObject& flags);
  /// Flags as a server takes them: texts, or a list of them for a flag that may be repeated.
  static QJsonObject toJson(const std::map<std::string, std::string>& flags);

signals:
  /// Picture of the last change; pictures of earlier changes are dropped.
  void refreshed(const qFenestraPreviewImage& picture);
  /// The last change was refused; the last picture stays.
  void refused(const QString& message);
  void ended(const qFenestraOutcome& outcome);

private:
  void sendChanges();
  void readEvent(const QString& line);

  qFenestraProgram* m_child = nullptr; ///< null: no server
  QTimer m_delay;
  QJsonObject m_changes; ///< not sent yet
  int m_lastId = 0;      ///< changes sent so far; also the last change's id
};
