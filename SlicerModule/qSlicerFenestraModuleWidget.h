#ifndef __qSlicerFenestraModuleWidget_h
#define __qSlicerFenestraModuleWidget_h

#include <qSlicerAbstractModuleWidget.h>

#include <ctkVTKObject.h>

#include "qSlicerFenestraModuleExport.h"
#include "qSlicerFenestraSession.h"

class qSlicerFenestraPanel;
class vtkMRMLFenestraRenderNode;
class vtkMRMLNode;

/// \brief The module's panel at work: settings live in a node of the scene; the panel shows and
/// edits that node, and the session follows it.
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

  /// None before the module's logic is known.
  qSlicerFenestraSession* session() const { return m_session; }

public slots:
  void setMRMLScene(vtkMRMLScene* scene) override;
  void render();
  void repeat();
  void loadSample();

protected:
  void setup() override;

protected slots:
  void onSceneReset();
  void onVolumeChosen(vtkMRMLNode* node);
  void onSegmentationChosen(vtkMRMLNode* node);
  void onPictureChosen(vtkMRMLNode* node);
  void onDataChanged();
  void showSegments();
  void showSettings();
  void takeSettings();
  void takeQuality();
  void save();

private:
  vtkSlicerFenestraLogic* fenestra() const;
  vtkMRMLFenestraRenderNode* settings() const { return m_settings; }
  vtkMRMLFenestraRenderNode* chosen() const;
  void connectPanel();
  void connectSession();
  void useScene();
  void chooseDefaults();
  void watch(const char* role, vtkMRMLNode* node);
  void watchCamera();
  void takeView(std::map<std::string, std::string>& flags);
  void showQuality(const std::map<std::string, std::string>& flags);
  void say(const QString& message, const QString& details = {});
  void showPicture(const QImage& picture, const qFenestraPicture& what);
  void onProgress(double part, double seconds);
  void onEnded(vtkMRMLFenestraRenderNode* render, const qFenestraOutcome& outcome);
  void showResult(vtkMRMLFenestraRenderNode* render);
  void updateButtons();

  qSlicerFenestraPanel* m_panel = nullptr;
  qSlicerFenestraSession* m_session = nullptr;
  vtkWeakPointer<vtkMRMLFenestraRenderNode> m_settings;
  vtkWeakPointer<vtkMRMLNode> m_volume, m_segmentation, m_camera;
  QString m_reached;      ///< of the render under way, in words
  bool m_showing = false; ///< the panel is being set, not used
};

#endif
