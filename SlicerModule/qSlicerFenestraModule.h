#ifndef __qSlicerFenestraModule_h
#define __qSlicerFenestraModule_h

#include <qSlicerLoadableModule.h>

#include <ctkVTKObject.h>

#include "qSlicerFenestraModuleExport.h"

class qSlicerFenestraSession;
class vtkSlicerFenestraLogic;

/// The loadable module: its texts, session and logic.
class Q_SLICER_QTMODULES_FENESTRA_EXPORT qSlicerFenestraModule : public qSlicerLoadableModule {
  Q_OBJECT
  Q_PLUGIN_METADATA(IID "org.slicer.modules.loadable.qSlicerLoadableModule/1.0");
  Q_INTERFACES(qSlicerLoadableModule);
  QVTK_OBJECT

public:
  typedef qSlicerLoadableModule Superclass;
  explicit qSlicerFenestraModule(QObject* parent = nullptr);
  ~qSlicerFenestraModule() override;

  qSlicerGetTitleMacro(QTMODULE_TITLE);
  QString helpText() const override;
  QString acknowledgementText() const override;
  QStringList contributors() const override;
  QIcon icon() const override;
  QStringList categories() const override;
  QStringList dependencies() const override;
  QStringList associatedNodeTypes() const override;

  /// Path of the renderer installed with this module.
  QString program() const;
  /// Renders for the panel and for scripts; null before setup.
  qSlicerFenestraSession* session() const { return m_session; }

public slots:
  void setMRMLScene(vtkMRMLScene* scene) override;

protected:
  void setup() override;
  qSlicerAbstractModuleRepresentation* createWidgetRepresentation() override;
  vtkMRMLAbstractLogic* createLogic() override;

private slots:
  void onSceneClosed();

private:
  Q_DISABLE_COPY(qSlicerFenestraModule);
  vtkSlicerFenestraLogic* fenestraLogic();

  qSlicerFenestraSession* m_session = nullptr;
};

#endif
