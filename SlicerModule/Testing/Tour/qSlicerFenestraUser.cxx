#include "qSlicerFenestraUser.h"

#include "qSlicerFenestraModuleWidget.h"
#include "vtkMRMLFenestraRenderNode.h"

#include <ctkCollapsibleButton.h>
#include <qSlicerApplication.h>
#include <qSlicerModuleSelectorToolBar.h>

#include <vtkMRMLScene.h>

#include <QAbstractButton>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QElapsedTimer>
#include <QLabel>
#include <QMainWindow>
#include <QScreen>
#include <QScrollArea>
#include <QTest>

#include <algorithm>
#include <iostream>

namespace {

using Node = vtkMRMLFenestraRenderNode;

std::vector<vtkMRMLNode*> renderNodes() {
  std::vector<vtkMRMLNode*> nodes;
  qSlicerApplication::application()->mrmlScene()->GetNodesByClass("vtkMRMLFenestraRenderNode",
                                                                  nodes);
  return nodes;
}

/// Factor on all waiting times.
int timeFactor() {
  return std::max(1, qEnvironmentVariableIntValue("FENESTRA_TOUR_PATIENCE"));
}

void processEvents() {
  QCoreApplication::processEvents(QEventLoop::AllEvents | QEventLoop::WaitForMoreEvents, 10);
}

} // namespace

qSlicerFenestraUser::qSlicerFenestraUser(const QString& report)
    : m_report(report), m_window(qSlicerApplication::application()->mainWindow()) {
  m_window->setGeometry(m_window->screen()->geometry()); // there may be no window manager
}

bool qSlicerFenestraUser::openModule() {
  auto* selector = m_window->findChild<qSlicerModuleSelectorToolBar*>();
  if (!selector)
    return false;
  selector->selectModule("Fenestra");
  if (auto* probe = m_window->findChild<ctkCollapsibleButton*>("DataProbeCollapsibleWidget"))
    probe->setCollapsed(true); // leaves its place to the panel
  wait(500);
  m_panel = m_window->findChild<qSlicerFenestraModuleWidget*>();
  if (!m_panel)
    return false;
  QObject::connect(m_panel->session(), &qSlicerFenestraSession::previewReceived, m_panel,
                   [this] { ++m_previews; });
  QObject::connect(m_panel->session(), &qSlicerFenestraSession::ended, m_panel,
                   [this] { ++m_ended; });
  return true;
}

bool qSlicerFenestraUser::click(const char* button) {
  auto* found = m_panel->findChild<QAbstractButton*>(button);
  if (!found || !found->isEnabled())
    return false;
  QTest::mousePress(found, Qt::LeftButton);
  wait(50); // a typical click
  QTest::mouseRelease(found, Qt::LeftButton);
  return true;
}

bool qSlicerFenestraUser::choose(const char* box, const QString& data) {
  auto* found = m_panel->findChild<QComboBox*>(box);
  const int index = found->findData(data);
  if (index >= 0)
    found->setCurrentIndex(index);
  return index >= 0;
}

void qSlicerFenestraUser::set(const char* box, double value) {
  m_panel->findChild<QDoubleSpinBox*>(box)->setValue(value);
}

void qSlicerFenestraUser::scrollTo(const char* widget) {
  auto* found = m_panel->findChild<QWidget*>(widget);
  for (QWidget* above = found; above; above = above->parentWidget())
    if (auto* area = qobject_cast<QScrollArea*>(above))
      area->ensureWidgetVisible(found, 0, 10);
}

void qSlicerFenestraUser::fold(const char* section, bool folded) {
  m_panel->findChild<ctkCollapsibleButton*>(section)->setCollapsed(folded);
  wait(300); // for the new layout
}

/// Takes a screenshot of the preview after a change.
bool qSlicerFenestraUser::takePreviewScreenshot(const char* name,
                                                const std::function<bool()>& action) {
  const int before = m_previews;
  if (!action() || !waitFor([&] { return m_previews > before; }))
    return false;
  wait(4000);
  takeScreenshot(name);
  return m_panel->findChild<QLabel*>("PreviewStateLabel")->text().contains("samples per pixel");
}

bool qSlicerFenestraUser::waitFor(const std::function<bool()>& condition, int milliseconds) {
  QElapsedTimer watch;
  watch.start();
  while (!condition() && watch.elapsed() / timeFactor() < milliseconds)
    processEvents();
  return condition();
}

void qSlicerFenestraUser::wait(int milliseconds) {
  QElapsedTimer watch;
  watch.start();
  while (watch.elapsed() / timeFactor() < milliseconds)
    processEvents();
}

void qSlicerFenestraUser::takeScreenshot(const char* name) {
  m_window->screen()->grabWindow(m_window->winId()).save(QString("%1/%2.png").arg(m_report, name));
  std::cout << "tour: " << name << std::endl;
}

Node* qSlicerFenestraUser::settings() const {
  return Node::SafeDownCast(qSlicerApplication::application()->mrmlScene()->GetSingletonNode(
      "Settings", "vtkMRMLFenestraRenderNode"));
}

Node* qSlicerFenestraUser::firstRender() const {
  for (vtkMRMLNode* node : renderNodes())
    if (!node->GetSingletonTag())
      return Node::SafeDownCast(node);
  return nullptr;
}

Node* qSlicerFenestraUser::lastRender() const {
  Node* last = nullptr;
  for (vtkMRMLNode* node : renderNodes())
    if (!node->GetSingletonTag() && node->GetNodeReference(Node::PictureRole))
      last = Node::SafeDownCast(node);
  return last;
}
