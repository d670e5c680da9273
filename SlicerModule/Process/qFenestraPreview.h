#pragma once
// A preview that follows what a user does: a `fenestra serve`, told of changes when hands rest for
// a moment, and its pictures as they get better.

#include "qFenestraProgram.h"

#include <QJsonObject>
#include <QTimer>

#include <memory>

struct qFenestraPicture {
  QStringList files;
  int samples = 0;      ///< a pixel
  double noise = -1.0;  ///< relative; negative where it is not known yet
  double seconds = 0.0; ///< since the change
  bool done = false;    ///< it will not get better
};

class qFenestraPreview : public QObject {
  Q_OBJECT

public:
  explicit qFenestraPreview(QObject* parent = nullptr);

  /// Milliseconds without another change before one is told.
  void setDelay(int milliseconds) { m_rest.setInterval(milliseconds); }

  /// `fenestra serve arguments…`; a preview under way ends. `files` are held until the child has
  /// ended, also where it is stopped before.
  void start(const QString& program, const QStringList& arguments, const QString& folder,
             const std::shared_ptr<const void>& files = {});
  /// Does not wait: the child ends by itself, unheard, and with this at the latest.
  void stop();
  bool running() const { return m_child && m_child->state() != QProcess::NotRunning; }
  /// Its files are relative to this folder.
  QString folder() const { return m_child ? m_child->workingDirectory() : QString(); }

  /// Flags and their values as `fenestra serve` takes them; later ones win.
  void change(const QJsonObject& flags);

signals:
  /// Of the last change; pictures that a newer one has overtaken are not told.
  void refreshed(const qFenestraPicture& picture);
  /// The last change could not be followed; what was shown stays.
  void refused(const QString& message);
  void ended(const qFenestraOutcome& outcome);

private:
  void tell();
  void hear(const QString& line);

  qFenestraProgram* m_child = nullptr; ///< null: none is heard
  QTimer m_rest;
  QJsonObject m_changes; ///< not told yet
  int m_told = 0;        ///< changes so far
};
