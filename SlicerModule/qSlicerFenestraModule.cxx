#include "qSlicerFenestraModule.h"

#include "qSlicerFenestraImageClicks.h"
#include "qSlicerFenestraLiveView.h"
#include "qSlicerFenestraModuleWidget.h"
#include "qSlicerFenestraSession.h"
#include "qSlicerFenestraSettingsPanel.h"
#include "qSlicerSubjectHierarchyFenestraPlugin.h"
#include "vtkSlicerFenestraLogic.h"

#include <qSlicerApplication.h>
#include <qSlicerSubjectHierarchyPluginHandler.h>

#include <ctkSettingsDialog.h>

#include <vtkMRMLScene.h>
#include <vtkMRMLThreeDViewDisplayableManagerFactory.h>

#include <vtkAutoInit.h>

#include <QDir>
#include <QFileInfo>

VTK_MODULE_INIT(vtkSlicerFenestraModuleMRMLDisplayableManager) // its object factory

qSlicerFenestraModule::qSlicerFenestraModule(QObject* parent) : Superclass(parent) {}

qSlicerFenestraModule::~qSlicerFenestraModule() {
  delete m_session; // before the logic that it uses
}

vtkSlicerFenestraLogic* qSlicerFenestraModule::fenestraLogic() {
  return vtkSlicerFenestraLogic::SafeDownCast(this->logic());
}

void qSlicerFenestraModule::setup() {
  Superclass::setup();
  m_session = new qSlicerFenestraSession(fenestraLogic(), program(), this);
  new qSlicerFenestraLiveView(fenestraLogic(), m_session); // the session owns it and the next
  new qSlicerFenestraImageClicks(fenestraLogic(), m_session);
  if (qSlicerApplication* application = qSlicerApplication::application()) {
    auto* panel = new qSlicerFenestraSettingsPanel; // the dialog owns it
    application->settingsDialog()->addPanel("Fenestra", panel);
    connect(panel, &qSlicerFenestraSettingsPanel::temporaryFolderChanged, m_session,
            &qSlicerFenestraSession::renewFiles);
  }
  qSlicerSubjectHierarchyPluginHandler::instance()->registerPlugin(
      new qSlicerSubjectHierarchyFenestraPlugin(fenestraLogic()));
  vtkMRMLThreeDViewDisplayableManagerFactory::GetInstance()->RegisterDisplayableManager(
      "vtkMRMLFenestraOpeningDisplayableManager");
}

void qSlicerFenestraModule::setMRMLScene(vtkMRMLScene* scene) {
  this->qvtkReconnect(this->mrmlScene(), scene, vtkMRMLScene::EndCloseEvent, this,
                      SLOT(onSceneClosed()));
  Superclass::setMRMLScene(scene);
}

void qSlicerFenestraModule::onSceneClosed() {
  if (m_session)
    m_session->closeScene();
}

QString qSlicerFenestraModule::helpText() const {
  return tr("Photorealistic rendering of a volume with an unobstructed view of the anatomy of "
            "interest. Choose a volume, a segmentation and the segments to show; a smooth surface "
            "through them clips the tissue in front. See the <a "
            "href=\"https://github.com/fenestra-render/SlicerFenestra#readme\">tutorial</a>.");
}

QString qSlicerFenestraModule::acknowledgementText() const {
  return tr(
      "Based on the paper \"Volumetric Clipping Surface: Un-occluded Visualization of Structures "
      "Preserving Depth Cues into Surrounding Organs\". For research and teaching; not a "
      "medical device.");
}

QStringList qSlicerFenestraModule::contributors() const {
  return {tr("The Fenestra authors")};
}

QIcon qSlicerFenestraModule::icon() const {
  return QIcon(":/Icons/Fenestra.png");
}

QStringList qSlicerFenestraModule::categories() const {
  return {"Rendering"};
}

QStringList qSlicerFenestraModule::dependencies() const {
  return {"Cameras", "Markups", "Segmentations", "SubjectHierarchy", "VolumeRendering", "Volumes"};
}

QStringList qSlicerFenestraModule::associatedNodeTypes() const {
  return {"vtkMRMLFenestraOpeningNode", "vtkMRMLFenestraRenderNode"};
}

/// Path relative to this library, where Slicer also finds the renderer as a command line module.
QString qSlicerFenestraModule::program() const {
  const QDir folder = QFileInfo(this->path()).dir();
#ifdef Q_OS_WIN
  const QString name = QStringLiteral("FenestraCommand.exe");
#else
  const QString name = QStringLiteral("FenestraCommand");
#endif
  return QDir::cleanPath(folder.filePath("../cli-modules/" + name));
}

qSlicerAbstractModuleRepresentation* qSlicerFenestraModule::createWidgetRepresentation() {
  return new qSlicerFenestraModuleWidget;
}

vtkMRMLAbstractLogic* qSlicerFenestraModule::createLogic() {
  return vtkSlicerFenestraLogic::New();
}
