#pragma once
// The panel as a user operates it: widgets to choose and click, and their texts.

#include "FenestraTesting.h"

#include "qSlicerFenestraModule.h"
#include "qSlicerFenestraModuleWidget.h"
#include "vtkMRMLFenestraRenderNode.h"
#include "vtkSlicerFenestraLogic.h"

#include <qMRMLNodeComboBox.h>
#include <qSlicerApplication.h>

#include <QComboBox>
#include <QDoubleSpinBox>

#include <memory>
#include <string>

namespace FenestraTesting {

/// Access to the panel's widgets by name.
struct Panel {
  using Node = vtkMRMLFenestraRenderNode;

  qSlicerFenestraModuleWidget* widget = nullptr;
  vtkSlicerFenestraLogic* logic = nullptr;

  template <typename Widget>
  Widget* find(const char* name) const {
    return widget->findChild<Widget*>(name);
  }
  Node* settings() const { return logic->GetSettings(); }
  void choose(const char* box, const QString& data) const {
    auto* combo = find<QComboBox>(box);
    combo->setCurrentIndex(combo->findData(data));
  }
  QString chosen(const char* box) const { return find<QComboBox>(box)->currentData().toString(); }
  bool isShown(const char* widget) const { return !find<QWidget>(widget)->isHidden(); }
  void set(const char* box, double value) const { find<QDoubleSpinBox>(box)->setValue(value); }
  std::string flag(const char* name) const { return settings()->GetFlag(name); }
  Node* chosenRender() const { return Node::SafeDownCast(nodes("RendersBox")->currentNode()); }
  qMRMLNodeComboBox* nodes(const char* name) const { return find<qMRMLNodeComboBox>(name); }
};

/// Slicer with the module and its panel. Arguments: the renderer, a folder for files, the module's
/// library.
struct Slicer {
  Slicer(int& argc, char* argv[]) : application(argc, argv), scene(application.mrmlScene()) {
    module.setName("Fenestra");
    module.setPath(argv[3]);
    module.initialize(application.applicationLogic());
    module.setMRMLScene(scene);
    owner.reset(dynamic_cast<qSlicerFenestraModuleWidget*>(module.widgetRepresentation()));
    panel = {owner.get(), vtkSlicerFenestraLogic::SafeDownCast(module.logic())};
  }

  qSlicerApplication application;
  vtkMRMLScene* scene;
  qSlicerFenestraModule module;
  std::unique_ptr<qSlicerFenestraModuleWidget> owner;
  Panel panel;
};

/// True if exactly one render ends after `action`.
template <typename Action>
bool endsOneRender(const Panel& panel, Action&& action) {
  int ended = 0;
  const auto connection = QObject::connect(panel.widget->session(), &qSlicerFenestraSession::ended,
                                           panel.widget, [&] { ++ended; });
  action();
  waitFor([&] { return ended > 0; });
  QObject::disconnect(connection);
  return ended == 1;
}

} // namespace FenestraTesting
