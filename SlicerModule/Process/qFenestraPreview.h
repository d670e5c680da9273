#pragma once
// Preview that follows the user's changes: sends them to `fenestra serve`, and receives images of
// increasing quality.

#include "FenestraFrame.h"
#include "qFenestraProgram.h"

#include <QFile>
#include <QJsonObject>
#include <QTimer>

#include <map>
#include <memory>
#include <string>

struct qFenestraPreviewImage {
  std::shared_ptr<const SlicerExport::Frame> frame;
  double seconds = 0.0;  ///< time since the change
  bool isCurrent = true; ///< false: there are newer changes, which are not sent yet
};

class qFenestraPreview : public QObject {
  Q_OBJECT

public:
  explicit qFenestraPreview(QObject* parent = nullptr);

  /// Starts `fenestra serve arguments…` in the folder and stops the running preview. `files` is
  /// kept alive until the child has ended, even after stop().
  void start(const QString& program, const QStringList& arguments, const QString& folder,
             const std::shared_ptr<const void>& files = {});
  /// Returns immediately. The child ends on its own, at the latest with this object; its further
  /// output is ignored.
  void stop();
  bool running() const { return m_child && m_child->state() != QProcess::NotRunning; }

  /// Changes flags, with values as `fenestra serve` takes them; later values win. Each change ends
  /// the render of the one before. It is therefore sent once there is an image of that one, so that
  /// images arrive however fast the changes are.
  void change(const QJsonObject& flags);
  /// Ends the current render. Later changes continue.
  void pause();
  /// Flags as `fenestra serve` takes them: a string, or a list of strings for a repeatable flag.
  static QJsonObject toJson(const std::map<std::string, std::string>& flags);

signals:
  /// Image of the last change; images of earlier changes are dropped.
  void refreshed(const qFenestraPreviewImage& image);
  /// The renderer rejected the last change; the last image stays.
  void refused(const QString& message);
  void ended(const qFenestraOutcome& outcome);

private:
  void sendChanges();
  void readEvent(const QString& line);
  /// Null: it is being replaced; another event follows.
  std::shared_ptr<const SlicerExport::Frame> readFrame();
  void closeFrame();

  qFenestraProgram* m_child = nullptr; ///< null: no server
  QFile m_file;                        ///< the images of the server, mapped
  const uchar* m_memory = nullptr;     ///< of the file; null: not mapped
  qint64 m_memoryBytes = 0;
  QTimer m_delay;           ///< 0 ms; merges the changes of one action
  QJsonObject m_changes;    ///< not sent yet
  int m_lastId = 0;         ///< number of changes sent; also the id of the last one
  bool m_isWaiting = false; ///< for the first reply to the last change
};
