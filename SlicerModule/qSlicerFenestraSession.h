#ifndef __qSlicerFenestraSession_h
#define __qSlicerFenestraSession_h

#include "FenestraSceneFiles.h"
#include "qFenestraAbilities.h"
#include "qFenestraFolder.h"
#include "qFenestraPreview.h"
#include "qFenestraQueue.h"
#include "qSlicerFenestraModuleExport.h"
#include "qSlicerFenestraResults.h"

#include <QDir>
#include <QElapsedTimer>
#include <QImage>
#include <QMap>
#include <QThreadPool>
#include <QTimer>

#include <functional>
#include <memory>

#include "vtkMRMLFenestraRenderNode.h"
#include "vtkSlicerFenestraLogic.h"
#include <vtkWeakPointer.h>

/// \brief What the panel has done: one preview that follows the settings, and renders one after the
/// other.
///
/// Files are written and read in a thread of its own, below a private folder that goes with the
/// scene; the scene is touched in the main thread alone. While a render is under way there is no
/// preview, which would take its time.
class Q_SLICER_QTMODULES_FENESTRA_EXPORT qSlicerFenestraSession : public QObject {
  Q_OBJECT

public:
  qSlicerFenestraSession(vtkSlicerFenestraLogic* logic, const QString& program,
                         QObject* parent = nullptr);
  ~qSlicerFenestraSession() override;

  enum class Kind { picture, turntable };
  /// Adds a render of the settings to the scene and to the queue. Null where something is missing:
  /// `ended` says what.
  vtkMRMLFenestraRenderNode* render(vtkMRMLFenestraRenderNode* settings, Kind kind = Kind::picture);
  /// Whether frames of a turntable are missing that this session can add.
  bool canResume(vtkMRMLFenestraRenderNode* turntable) const;
  /// Goes on with it: its frames are more then.
  void resume(vtkMRMLFenestraRenderNode* turntable);
  /// Ends the render under way, which keeps what it has; called again, without.
  void stop();
  /// The render under way has been told to end.
  bool stopping() const { return rendering() && m_renders.first().stopped; }
  /// The scene is closed: its renders, results and files go with it.
  void closeScene();
  bool rendering() const { return !m_renders.isEmpty(); }
  int waiting() const { return rendering() ? static_cast<int>(m_renders.size()) - 1 : 0; }

  /// Shows the settings as they are from now on, or no more where there are none.
  void preview(vtkMRMLFenestraRenderNode* settings);

  /// Makes the renderer's synthetic knee, and then tells its scene's path, or what failed.
  void makeSample(const std::function<void(const QString& scene, const QString& failure)>& then);

  const qSlicerFenestraResults& results() const { return m_results; }

public slots:
  /// Something may have changed: settings, camera, volume, segments, transfer function.
  void refresh();

signals:
  /// What the renderer knows; once, soon after the session began.
  void learned(const qFenestraAbilities& abilities);
  void previewed(const QImage& picture, const qFenestraPicture& what);
  /// A sentence for the user; what was shown stays.
  void previewRefused(const QString& message);
  void started(vtkMRMLFenestraRenderNode* render);
  /// `part` of the work, after `seconds`.
  void progressed(vtkMRMLFenestraRenderNode* render, double part, double seconds);
  /// Samples and noise of the render under way, in words.
  void reached(const QString& words);
  /// The process of the render under way is no more; its result is still to be read.
  void renderStopped();
  /// With its result in the scene, where there is one.
  void ended(vtkMRMLFenestraRenderNode* render, const qFenestraOutcome& outcome);

private:
  static constexpr const char* folderPrefix = "fenestra-slicer-";
  /// Of one scene: the working thread's.
  struct Files {
    qFenestraFolder folder{QDir::tempPath(), folderPrefix};
    FenestraScene::Writer writer{folder.path().toStdString()};
  };
  struct Render {
    vtkWeakPointer<vtkMRMLFenestraRenderNode> node;
    std::shared_ptr<Files> files; ///< which stay until its process has ended
    QString folder;               ///< empty until it is written
    bool stopped = false;
  };

  void work(const std::function<void()>& job);
  void later(const std::function<void()>& job);
  void write(const FenestraScene::Contents& contents,
             const std::function<void(const QString& scene, const QString& failure)>& then);
  QStringList arguments(vtkMRMLFenestraRenderNode* render, const QString& scene,
                        bool withSurface) const;
  void finishRender(int id, const qFenestraOutcome& outcome);
  void addResult(int id, const qFenestraOutcome& outcome,
                 const std::function<void(vtkMRMLFenestraRenderNode*, int)>& add, int step = 0);
  void endRender(int id, const qFenestraOutcome& outcome);

  void follow();
  void startPreview(const FenestraScene::Contents& contents, const QJsonObject& flags);
  QJsonObject previewFlags(std::map<std::string, std::string> flags,
                           const FenestraScene::Contents& contents) const;
  QString propertyFile(const FenestraScene::Contents& contents) const;
  void tellPreview(const QJsonObject& flags);
  void showPreview(const qFenestraPicture& picture);

  vtkSlicerFenestraLogic* m_logic;
  QString m_program;
  std::shared_ptr<Files> m_files; ///< of the scene that is open
  /// The sample, once it is made: of no patient, and a scene that was saved may refer to it.
  std::unique_ptr<qFenestraFolder> m_sample;
  QThreadPool m_worker;

  qFenestraQuestion m_question;
  qFenestraQueue m_queue;
  QMap<int, Render> m_renders; ///< under way and waiting
  qSlicerFenestraResults m_results;
  QElapsedTimer m_watch;
  int m_last = 0;

  qFenestraPreview m_preview;
  QTimer m_soon; ///< several changes at once are one
  vtkWeakPointer<vtkMRMLFenestraRenderNode> m_previewed;
  std::string m_shownData; ///< what the preview's scene holds
  QString m_previewFolder;
  QJsonObject m_told;
  bool m_starting = false;
};

#endif
