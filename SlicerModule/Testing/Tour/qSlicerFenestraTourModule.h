#ifndef __qSlicerFenestraTourModule_h
#define __qSlicerFenestraTourModule_h

#include <qSlicerLoadableModule.h>

#include "qSlicerFenestraTourModuleExport.h"

/// Starts the tour after the application's start, if FENESTRA_TOUR names a folder for its report.
class Q_SLICER_QTMODULES_FENESTRATOUR_EXPORT qSlicerFenestraTourModule
    : public qSlicerLoadableModule {
  Q_OBJECT
  Q_PLUGIN_METADATA(IID "org.slicer.modules.loadable.qSlicerLoadableModule/1.0");
  Q_INTERFACES(qSlicerLoadableModule);

public:
  typedef qSlicerLoadableModule Superclass;
  explicit qSlicerFenestraTourModule(QObject* parent = nullptr) : Superclass(parent) {}

  qSlicerGetTitleMacro(QTMODULE_TITLE);
  QString helpText() const override { return "Performs the tutorial automatically."; }
  QString acknowledgementText() const override { return "For tests and screenshots."; }
  bool isHidden() const override { return true; }
  QStringList dependencies() const override { return {"Fenestra"}; }

protected:
  void setup() override;
  qSlicerAbstractModuleRepresentation* createWidgetRepresentation() override { return nullptr; }
  vtkMRMLAbstractLogic* createLogic() override { return nullptr; }
};

#endif
