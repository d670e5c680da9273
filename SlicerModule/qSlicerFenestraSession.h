#ifndef __qSlicerFenestraSession_h
#define __qSlicerFenestraSession_h

#include "FenestraSceneFiles.h"
#include "clip/portable/LiveSurface.h"
#include "qFenestraFolder.h"
#include "qFenestraMaterials.h"
#include "qFenestraPreview.h"
#include "qFenestraQueue.h"
#include "qSlicerFenestraApplicationSettings.h"
#include "qSlicerFenestraModuleExport.h"
#include "qSlicerFenestraResults.h"

#include <QDir>
#include <QElapsedTimer>
#include <QImage>
#include <QMap>
#include <QPointer>
#include <QThreadPool>
#include <QTimer>

#include <ctkVTKObject.h>

#include <functional>
#include <memory>

#include "vtkMRMLFenestraOpeningNode.h"
#include "vtkMRMLFenestraRenderNode.h"
#include "vtkSlicerFenestraLogic.h"
#include <vtkWeakPointer.h>

/// \brief Rendering for the panel and for scripts: one preview that follows the settings, a queue
/// of renders, and the focus of the opened view. Failures are also logged.
///
/// A worker thread writes and reads the files, in a private folder that is removed with the scene.
/// Only the main thread changes the scene. During a render there is no preview, which would slow
/// the render down. Renders are requested from the logic, whose events the session observes.
class Q_SLICER_QTMODULES_FENESTRA_EXPORT qSlicerFenestraSession : public QObject {
  Q_OBJECT
  QVTK_OBJECT

public:
  /// `program`: the installed renderer; the application settings may name another one.
  qSlicerFenestraSession(vtkSlicerFenestraLogic* logic, const QString& program,
                         QObject* parent = nullptr);
  ~qSlicerFenestraSession() override;

  enum class Kind { picture, turntable };
  /// Requests a render of the settings from the logic. Null: an input is missing; `ended` reports
  /// the reason.
  vtkMRMLFenestraRenderNode* render(vtkMRMLFenestraRenderNode* settings, Kind kind = Kind::picture);
  /// True if the turntable is incomplete and can be resumed here.
  bool canResume(vtkMRMLFenestraRenderNode* turntable) const;
  /// Renders the missing frames.
  void resume(vtkMRMLFenestraRenderNode* turntable);
  /// True once the current render has been asked to stop.
  bool isStopping() const { return isRendering() && m_renders.first().stopped; }
  /// Stops all renders, and drops results and files of the closed scene.
  void closeScene();
  bool isRendering() const { return !m_renders.isEmpty(); }
  int waitingCount() const { return isRendering() ? static_cast<int>(m_renders.size()) - 1 : 0; }

  /// Queries the materials that the renderer chooses for the segments; `materialsReceived` reports
  /// them. Unchanged segments are not queried again.
  void queryMaterials(const std::vector<SlicerExport::Segment>& segments);
  using Flags = std::map<std::string, std::string>;
  /// Previews the settings from now on; null: ends the preview.
  void preview(vtkMRMLFenestraRenderNode* settings);
  /// Previews settings with other flags for camera, size and background from now on, instead of
  /// preview(); null: ends that.
  void previewView(vtkMRMLFenestraRenderNode* settings, const Flags& view);
  /// Ends the render of the current preview, whose view changes. The next change continues.
  void pausePreview();

  /// Generates the synthetic sample knee, then calls `then` with the path of its scene or with an
  /// error message. `sampleProgressed` reports the time until then. Returns false, and does
  /// nothing, while one is generated.
  bool makeSample(const std::function<void(const QString& scene, const QString& failure)>& then);
  /// Adds the generated sample to the scene, and shows it.
  void loadSample(const QString& scene);

  const qSlicerFenestraResults& results() const { return m_results; }

public slots:
  /// Stops the current render and keeps finished results; a second call discards them.
  void stop();
  /// Updates the preview. Call when settings, camera, volume, segments or transfer function may
  /// have changed.
  void refresh();
  /// Uses the folder for temporary files that the application settings name now. Files of earlier
  /// renders stay where they are.
  void renewFiles();

signals:
  void materialsReceived(const qFenestraMaterials& materials);
  void previewReceived(const QImage& picture, const qFenestraPreviewImage& what);
  /// `message`: a sentence for the user. The last preview stays visible.
  void previewRefused(const QString& message);
  void started(vtkMRMLFenestraRenderNode* render);
  /// `fraction`: finished fraction, 0 to 1; `seconds`: elapsed time.
  void progressed(vtkMRMLFenestraRenderNode* render, double fraction, double seconds);
  /// The sample is being generated for `seconds`: 0 at once, then twice a second.
  void sampleProgressed(double seconds);
  /// Samples and noise of the current render, as text.
  void statusChanged(const QString& text);
  /// The process of the current render has ended; its result is not read yet.
  void renderStopped();
  /// The render's result, if any, is in the scene.
  void ended(vtkMRMLFenestraRenderNode* render, const qFenestraOutcome& outcome);

private slots:
  void onRenderRequested(vtkObject* logic, vtkObject* render);
  void onRenderWait(vtkObject* logic, vtkObject* render);
  void onOpeningWait();
  void onSampleRequested();
  void onViewChanged();
  void onOpeningChanged();
  void onOpenedDataChanged();
  void refreshOpening();

private:
  static constexpr const char* folderPrefix = "fenestra-slicer-";
  /// Files of one scene, for the worker thread.
  struct Files {
    qFenestraFolder folder{qSlicerFenestraApplicationSettings::findTemporaryFolder(), folderPrefix};
    SlicerExport::Writer writer{folder.path().toStdString()};
  };
  struct Render {
    vtkWeakPointer<vtkMRMLFenestraRenderNode> node;
    std::shared_ptr<Files> files; ///< kept alive until the process has ended
    QString folder;               ///< empty until the scene is written
    bool stopped = false;
  };

  QString program() const;                         ///< of the next process
  static void removeFolder(const QString& folder); ///< empty: none
  /// The renderer's message without file names in this session's folder.
  static QString toUserText(QString message, const QString& folder);
  void runInWorker(const std::function<void()>& job);
  void runInMainThread(const std::function<void()>& job);
  void write(const SlicerExport::Contents& contents,
             const std::function<void(const QString& scene, const QString& failure)>& then);
  QStringList makeArguments(vtkMRMLFenestraRenderNode* render, const QString& scene,
                            bool withSurface) const;
  void submit(int id, const SlicerExport::Contents& contents, bool withSurface, int tries = 3);
  void finishRender(int id, const qFenestraOutcome& outcome);
  void addResult(int id, const qFenestraOutcome& outcome,
                 const std::function<void(vtkMRMLFenestraRenderNode*, int)>& add, int step = 0);
  void endRender(int id, const qFenestraOutcome& outcome);

  void updatePreview();
  vtkMRMLFenestraRenderNode* previewed() const { return m_viewed ? m_viewed : m_previewed; }
  void startPreview(const SlicerExport::Contents& contents, const Flags& flags);
  Flags adaptFlags(Flags flags, const SlicerExport::Contents& contents) const;
  QString writePropertyFile(const SlicerExport::Contents& contents) const;
  void sendToPreview(const QJsonObject& flags);
  void showPreview(const qFenestraPreviewImage& picture);

  void updateOpening();
  void showOpeningProblem();
  void setOpeningProblem(const std::string& problem);
  bool isOpeningPending() const;
  void observeOpening(vtkMRMLFenestraRenderNode* settings);
  void startFocus(const SlicerExport::Contents& contents, const Flags& flags);
  using Focus = vtkMRMLFenestraOpeningNode::Focus;
  void readFocus(const QString& folder, const std::shared_ptr<Files>& files,
                 const std::function<void(const Focus& focus, const QString& problem)>& then);
  void endFocus(vtkMRMLFenestraOpeningNode* opening, const Focus& focus,
                const fenestra::core::BoxCorners& corners, const QString& problem);

  vtkSlicerFenestraLogic* m_logic;
  QString m_installedProgram;
  std::shared_ptr<Files> m_files;               ///< of the open scene
  QList<std::shared_ptr<Files>> m_earlierFiles; ///< of its renders before renewFiles
  /// Folder of the sample, once generated. It outlives the scene: it holds no patient data, and
  /// saved scenes may refer to it.
  std::unique_ptr<qFenestraFolder> m_sample;
  QElapsedTimer m_sampleTime;
  QTimer m_sampleTimer; ///< active while the sample is generated
  QThreadPool m_worker;

  qFenestraMaterialsQuery m_materials;
  std::vector<SlicerExport::Segment> m_queriedSegments; ///< segments of the last query
  qFenestraQueue m_queue;
  QMap<int, Render> m_renders; ///< running and waiting
  qSlicerFenestraResults m_results;
  QElapsedTimer m_renderTime;
  int m_lastId = 0;

  qFenestraPreview m_preview;
  QTimer m_refreshTimer; ///< merges changes; not restarted by further ones
  vtkWeakPointer<vtkMRMLFenestraRenderNode> m_previewed; ///< by the panel; null: none
  vtkWeakPointer<vtkMRMLFenestraRenderNode> m_viewed;    ///< in a 3D view; null: none
  Flags m_viewFlags;                                     ///< of that view
  std::string m_previewKey;                              ///< key of the data in the preview's scene
  QString m_previewFolder;
  QJsonObject m_sentFlags;
  bool m_starting = false;

  vtkWeakPointer<vtkMRMLFenestraOpeningNode> m_opening;
  vtkWeakPointer<vtkMRMLNode> m_openedSettings, m_openedVolume, m_openedSegmentation; ///< observed
  QTimer m_openingTimer; ///< merges changes; not restarted by further ones
  bool m_isOpenedDataChanged = false;
  Flags m_focusFlags;
  std::string m_focusKey;     ///< of the triangles that the opened view has, or will have
  std::string m_focusProblem; ///< why the last focus could not be made; empty: it was
  QPointer<qFenestraProgram> m_focusProgram;
};

#endif
