#ifndef __qSlicerFenestraModuleWidget_h
#define __qSlicerFenestraModuleWidget_h

#include <qSlicerAbstractModuleWidget.h>

#include <ctkVTKObject.h>

#include <QPointer>

#include "qSlicerFenestraModuleExport.h"
#include "qSlicerFenestraSession.h"

class qFenestraCopies;
class qSlicerFenestraPanel;
class qSlicerFenestraSettings;
class vtkMRMLFenestraRenderNode;

/// \brief Controller of the panel. A scene node stores the settings; the panel shows and edits the
/// node, and the session renders it.
class Q_SLICER_QTMODULES_FENESTRA_EXPORT qSlicerFenestraModuleWidget
    : public qSlicerAbstractModuleWidget {
  Q_OBJECT
  QVTK_OBJECT

public:
  typedef qSlicerAbstractModuleWidget Superclass;
  explicit qSlicerFenestraModuleWidget(QWidget* parent = nullptr);
  ~qSlicerFenestraModuleWidget() override;

  void enter() override;
  void exit() override;

  /// Null before the module's logic is known.
  qSlicerFenestraSession* session() const { return m_session; }

public slots:
  void setMRMLScene(vtkMRMLScene* scene) override;
  void render();
  void renderTurntable();
  void stop();
  void repeat();
  void loadSample();

protected:
  void setup() override;

private slots:
  void onSceneClosed();
  void onSceneImported();
  void useNewScene();
  void onRenderChosen();
  void save();

private:
  vtkSlicerFenestraLogic* fenestraLogic() const;
  vtkMRMLFenestraRenderNode* chosenRender() const;
  void connectPanel();
  void connectSession();
  void useScene();
  void preview();
  bool hasVolume() const;
  void updateButtons();
  void showSelected();
  void start(qSlicerFenestraSession::Kind kind);
  void showMeasures(vtkMRMLFenestraRenderNode* render);
  void saveAs(const qFenestraCopies& copies);
  void setStatus(const QString& message, const QString& details = {});
  void clearStatus();
  void showPreviewImage(const QImage& image, const qFenestraPreviewImage& info);
  void onProgress(double fraction, double seconds);
  QString toUserText(vtkMRMLFenestraRenderNode* render, qFenestraOutcome::Kind kind) const;
  void onEnded(vtkMRMLFenestraRenderNode* render, const qFenestraOutcome& outcome);
  void showResult(vtkMRMLFenestraRenderNode* render, int times = 2);

  qSlicerFenestraPanel* m_panel = nullptr;
  qSlicerFenestraSettings* m_settings = nullptr;
  QPointer<qSlicerFenestraSession> m_session; ///< owned by the module, which may end earlier
  bool m_sceneIsNew = false;                  ///< scene closed or loaded, but not shown yet
  QString m_samplesAndNoise;                  ///< samples and noise of the current render, as text
  QElapsedTimer m_progressAge;                ///< time since progress was last shown
};

#endif
