#ifndef __qSlicerFenestraModuleWidget_h
#define __qSlicerFenestraModuleWidget_h

#include <qSlicerAbstractModuleWidget.h>

#include <ctkVTKObject.h>

#include "qSlicerFenestraModuleExport.h"
#include "qSlicerFenestraSession.h"

class qSlicerFenestraModuleWidgetPrivate;
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
  qSlicerFenestraSession* session() const;

public slots:
  void setMRMLScene(vtkMRMLScene* scene) override;
  void render();
  void renderTurntable();
  void stop();
  void repeat();
  void loadSample();

protected:
  QScopedPointer<qSlicerFenestraModuleWidgetPrivate> d_ptr;

  void setup() override;

private slots:
  void onSceneClosed();
  void onSceneImported();
  void useNewScene();
  void onRenderChosen();
  void save();

private:
  Q_DECLARE_PRIVATE(qSlicerFenestraModuleWidget)
  Q_DISABLE_COPY(qSlicerFenestraModuleWidget)

  vtkSlicerFenestraLogic* fenestraLogic() const;
  void connectPanel();
  void connectSession();
  void useScene();
  void followView();
  void preview();
  void updateButtons();
  void showSelected();
  void start(qSlicerFenestraSession::Kind kind);
  void onProgress(double fraction, double seconds);
  void onEnded(vtkMRMLFenestraRenderNode* render, const qFenestraOutcome& outcome);
  void showResult(vtkMRMLFenestraRenderNode* render);
};

#endif
