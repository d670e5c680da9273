#include "qSlicerFenestraTour.h"

#include "qSlicerFenestraModuleWidget.h"
#include "vtkMRMLFenestraRenderNode.h"

#include <ctkCollapsibleGroupBox.h>
#include <qMRMLNodeComboBox.h>
#include <qSlicerApplication.h>
#include <qSlicerCLIModule.h>
#include <qSlicerCLIModuleWidget.h>
#include <qSlicerCoreIOManager.h>
#include <qSlicerModuleManager.h>
#include <qSlicerModuleSelectorToolBar.h>

#include <vtkCamera.h>
#include <vtkImageData.h>
#include <vtkMRMLApplicationLogic.h>
#include <vtkMRMLCameraNode.h>
#include <vtkMRMLCommandLineModuleNode.h>
#include <vtkMRMLDisplayNode.h>
#include <vtkMRMLScene.h>
#include <vtkMRMLSliceCompositeNode.h>
#include <vtkMRMLSliceLogic.h>
#include <vtkMRMLSliceNode.h>
#include <vtkMRMLVolumeNode.h>
#include <vtkSlicerCLIModuleLogic.h>

#include <QAbstractButton>
#include <QComboBox>
#include <QFile>
#include <QJsonDocument>
#include <QLabel>
#include <QListWidget>
#include <QMainWindow>
#include <QSlider>
#include <QSpinBox>
#include <QTest>

#include <algorithm>
#include <set>

namespace {

using Node = vtkMRMLFenestraRenderNode;

QByteArray copyRadiance(Node* render) {
  auto* volume = vtkMRMLVolumeNode::SafeDownCast(render->GetNodeReference(Node::RadianceRole));
  if (!volume)
    return {};
  constexpr int pixelBytes = 4 * sizeof(float); // RGBA
  return QByteArray(static_cast<const char*>(volume->GetImageData()->GetScalarPointer()),
                    static_cast<int>(volume->GetImageData()->GetNumberOfPoints()) * pixelBytes);
}

} // namespace

qSlicerFenestraTour::qSlicerFenestraTour(const QString& report) : qSlicerFenestraUser(report) {}

bool qSlicerFenestraTour::run() {
  wait(1000);
  takeScreenshot("1-start");
  struct Step {
    const char* name;
    bool (qSlicerFenestraTour::*run)();
  };
  const Step steps[] = {{"load", &qSlicerFenestraTour::loadPhantom},
                        {"open", &qSlicerFenestraTour::showModule},
                        {"choose", &qSlicerFenestraTour::chooseCartilage},
                        {"turn", &qSlicerFenestraTour::turnCamera},
                        {"openView", &qSlicerFenestraTour::openView},
                        {"restView", &qSlicerFenestraTour::restView},
                        {"render", &qSlicerFenestraTour::render},
                        {"stop", &qSlicerFenestraTour::stopRender},
                        {"clipping", &qSlicerFenestraTour::changeClipping},
                        {"view", &qSlicerFenestraTour::changeView},
                        {"measures", &qSlicerFenestraTour::renderMeasured},
                        {"turntable", &qSlicerFenestraTour::renderTurntable},
                        {"repeat", &qSlicerFenestraTour::saveAndRepeat},
                        {"command", &qSlicerFenestraTour::runCommand}};
  bool good = true;
  for (const Step& step : steps) {
    good = good && (this->*step.run)();
    if (!good) {
      m_measurements["failed"] = step.name;
      takeScreenshot("failed");
      break;
    }
  }
  m_measurements["slicer"] = qSlicerApplication::application()->applicationVersion();
  QFile file(m_report + "/tour.json");
  if (file.open(QIODevice::WriteOnly))
    file.write(QJsonDocument(m_measurements).toJson());
  return good;
}

bool qSlicerFenestraTour::loadPhantom() {
  if (!qSlicerApplication::application()->coreIOManager()->loadScene(m_report + "/knee/knee.mrml"))
    return false;
  auto* fenestra = qSlicerApplication::application()->moduleLogic("Fenestra");
  vtkSlicerFenestraLogic::SafeDownCast(fenestra)->ShowNewestVolume(); // as loadSample() does
  wait(2000);
  takeScreenshot("2-loaded");
  return true;
}

bool qSlicerFenestraTour::showModule() {
  if (!openModule() || !waitFor([this] { return m_previews > 0; }))
    return false;
  wait(1500);
  takeScreenshot("3-opened");
  return true;
}

/// Chooses segments by mouse clicks on their check boxes.
bool qSlicerFenestraTour::chooseCartilage() {
  auto* list = m_panel->findChild<QListWidget*>("FocusList");
  const QList<QListWidgetItem*> items = list->findItems("cartilage", Qt::MatchContains);
  if (items.isEmpty())
    return false;
  m_pulse.start();
  QElapsedTimer watch;
  const int before = m_previews;
  for (QListWidgetItem* item : items) {
    list->scrollToItem(item);
    const QRect row = list->visualItemRect(item);
    watch.start();
    QTest::mouseClick(list->viewport(), Qt::LeftButton, {}, {row.left() + 10, row.center().y()});
    if (item->checkState() != Qt::Checked)
      return false;
  }
  if (!waitFor([&] { return m_previews > before; }))
    return false;
  m_measurements["previewAfterFocusMs"] = static_cast<int>(watch.elapsed());
  wait(8000); // that preview may still be one of the old focus
  m_measurements["longestPauseWhilePreviewingMs"] = m_pulse.longest();
  takeScreenshot("4-focus");
  return true;
}

/// Measures without and with Slicer's own volume rendering, which is slow without a GPU.
bool qSlicerFenestraTour::turnCamera() {
  showVolumeRendering(false);
  const int alone = slowestTurn();
  m_measurements["previewAfterTurnMs"] = alone;
  showVolumeRendering(true);
  const int beside = slowestTurn();
  m_measurements["previewAfterTurnBesideVolumeRenderingMs"] = beside;
  wait(3000);
  takeScreenshot("5-turned");
  return alone >= 0 && beside >= 0;
}

void qSlicerFenestraTour::showVolumeRendering(bool visible) {
  std::vector<vtkMRMLNode*> displays;
  qSlicerApplication::application()->mrmlScene()->GetNodesByClass(
      "vtkMRMLVolumeRenderingDisplayNode", displays);
  for (vtkMRMLNode* display : displays)
    vtkMRMLDisplayNode::SafeDownCast(display)->SetVisibility(visible);
  wait(1000);
}

int qSlicerFenestraTour::slowestTurn() {
  auto* camera = vtkMRMLCameraNode::SafeDownCast(
      qSlicerApplication::application()->mrmlScene()->GetFirstNodeByClass("vtkMRMLCameraNode"));
  int slowest = 0;
  for (int turn = 0; turn < 5; ++turn) {
    wait(300);
    const int before = m_previews;
    QElapsedTimer watch;
    watch.start();
    camera->GetCamera()->Azimuth(10.0);
    camera->GetCamera()->Elevation(3.0);
    if (!waitFor([&] { return m_previews > before; }))
      return -1;
    slowest = std::max(slowest, static_cast<int>(watch.elapsed()));
  }
  return slowest;
}

bool qSlicerFenestraTour::render() {
  if (auto* quality = m_panel->findChild<QComboBox*>("QualityBox"))
    quality->setCurrentIndex(qEnvironmentVariableIntValue("FENESTRA_TOUR_QUALITY"));
  wait(1000);
  const int before = m_ended;
  if (!click("RenderButton"))
    return false;
  const auto* progress = m_panel->findChild<QWidget*>("ProgressBar");
  if (!waitFor([progress] { return progress->isVisible(); }))
    return false;
  wait(1500);
  takeScreenshot("6-rendering");
  if (!waitFor([&] { return m_ended > before; }, 300000))
    return false;
  m_measurements["render"] = m_panel->findChild<QLabel*>("StateLabel")->text();
  wait(8000); // volume rendering in a new view is slow without a GPU
  takeScreenshot("7-result");
  return lastRender() && !copyRadiance(lastRender()).isEmpty();
}

/// Hides Slicer's own volume rendering, to measure only the module's pauses.
bool qSlicerFenestraTour::stopRender() {
  showVolumeRendering(false);
  Node* const settings = this->settings();
  const std::map<std::string, std::string> flags = settings->GetFlags();
  std::map<std::string, std::string> endless = flags;
  endless["samples"] = "1000000";
  endless.erase("noise");
  settings->SetFlags(endless);
  const int before = m_ended;
  m_pulse.start();
  if (!click("RenderButton"))
    return false;
  wait(3000);
  m_measurements["longestPauseWhileRenderingMs"] = m_pulse.longest();
  m_pulse.start();
  QElapsedTimer watch;
  watch.start();
  auto* session = m_panel->session();
  int after = -1;
  const auto connection = QObject::connect(session, &qSlicerFenestraSession::renderStopped,
                                           [&] { after = static_cast<int>(watch.elapsed()); });
  if (!click("StopButton") || !waitFor([&] { return m_ended > before; }))
    return false;
  QObject::disconnect(connection);
  m_measurements["stoppedAfterMs"] = after;
  wait(1000);
  m_measurements["longestPauseWithResultMs"] = m_pulse.longest();
  settings->SetFlags(flags);
  showVolumeRendering(true);
  return lastRender() != nullptr;
}

/// Shows the best image so far, which is the first, beside the previews. Folds the section above,
/// so that preview and clipping are visible together.
bool qSlicerFenestraTour::changeClipping() {
  showVolumeRendering(false);
  m_panel->findChild<qMRMLNodeComboBox*>("RendersBox")->setCurrentNode(firstRender());
  if (!click("ShowButton"))
    return false;
  fold("WhatToShow", true);
  fold("ClippingSection", false);
  const bool hole = takePreviewScreenshot("12-hole", [this] {
    const bool chosen = choose("ClipBox", "hole");
    set("holemarginBox", 8.0);
    scrollTo("PreviewBox");
    return chosen;
  });
  const bool surroundings = takePreviewScreenshot("13-surroundings", [this] {
    auto* details = m_panel->findChild<ctkCollapsibleGroupBox*>("ClipDetails");
    details->setCollapsed(false);
    const bool chosen = choose("ClipBox", "");
    set("contextsaturationBox", 30.0);
    wait(300);
    scrollTo("ClipDetails");
    scrollTo("PreviewLabel");
    return chosen;
  });
  m_panel->findChild<ctkCollapsibleGroupBox*>("ClipDetails")->setCollapsed(true);
  fold("ClippingSection", true);
  return hole && surroundings && settings()->GetFlag("boundary") == "exact" &&
         settings()->GetFlag("hole").empty() && settings()->GetFlag("soft").empty();
}

bool qSlicerFenestraTour::changeView() {
  const bool best = takePreviewScreenshot("14-view", [this] {
    fold("ViewAndLight", false);
    scrollTo("PreviewBox");
    return choose("ViewBox", "auto");
  });
  fold("WhatToShow", false);
  return best && takePreviewScreenshot("15-anatomy", [this] {
           scrollTo("PreviewBox");
           return choose("PresetBox", "knee-cartilage");
         });
}

bool qSlicerFenestraTour::renderMeasured() {
  choose("QualityBox", "16 0 0");
  const int before = m_ended;
  if (!click("RenderButton") || !waitFor([&] { return m_ended > before; }, 300000))
    return false;
  wait(2000);
  fold("ViewAndLight", true);
  scrollTo("SaveButton");
  wait(500);
  takeScreenshot("16-measures");
  auto* measures = m_panel->findChild<QLabel*>("MeasuresLabel");
  m_measurements["measures"] = measures->text();
  return measures->isVisible() && measures->text().contains("Focus visible");
}

/// Renders and plays a few small frames.
bool qSlicerFenestraTour::renderTurntable() {
  fold("Turntable", false);
  const std::map<std::string, std::string> flags = settings()->GetFlags();
  settings()->SetFlag("size", "256x256");
  m_panel->findChild<QSpinBox*>("FramesBox")->setValue(8);
  set("DegreesBox", 120.0);
  wait(300);
  scrollTo("StateLabel");
  scrollTo("TurnButton");
  const int before = m_ended;
  if (!click("TurnButton"))
    return false;
  wait(3000);
  takeScreenshot("17-turning");
  if (!waitFor([&] { return m_ended > before; }, 300000))
    return false;
  wait(3000);
  fold("Turntable", true);
  scrollTo("SaveButton");
  auto* slider = m_panel->findChild<QSlider*>("FrameSlider");
  std::set<int> shownFrames;
  const auto connection = QObject::connect(
      slider, &QSlider::valueChanged, [&shownFrames](int frame) { shownFrames.insert(frame); });
  click("PlayButton");
  const bool played = waitFor([&] { return shownFrames.size() == 8; });
  click("PlayButton");
  QObject::disconnect(connection);
  slider->setValue(5);
  wait(1000);
  takeScreenshot("18-turntable");
  m_measurements["turntable"] = m_panel->findChild<QLabel*>("DescriptionLabel")->text();
  settings()->SetFlags(flags);
  return played && vtkSlicerFenestraLogic::GetNumberOfFrames(lastRender()) == 8;
}

bool qSlicerFenestraTour::saveAndRepeat() {
  vtkMRMLScene* scene = qSlicerApplication::application()->mrmlScene();
  Node* const first = firstRender();
  if (!first)
    return false;
  const QByteArray before = copyRadiance(first);
  const std::string name = first->GetName();
  const int frames = vtkSlicerFenestraLogic::GetNumberOfFrames(lastRender());
  qSlicerIO::IOProperties properties;
  const QString file = m_report + "/saved.mrb";
  properties["fileName"] = file;
  auto* io = qSlicerApplication::application()->coreIOManager();
  if (!io->saveNodes("SceneFile", properties))
    return false;
  scene->Clear(false);
  wait(1000);
  takeScreenshot("8-closed");
  for (const char* label : {"StateLabel", "PreviewStateLabel", "DescriptionLabel"})
    if (!m_panel->findChild<QLabel*>(label)->text().isEmpty())
      return false;
  const int previews = m_previews;
  if (!io->loadScene(file) || !waitFor([&] { return m_previews > previews; }))
    return false;
  wait(2000);
  auto* again = Node::SafeDownCast(scene->GetFirstNodeByName(name.c_str()));
  if (!again)
    return false;
  m_measurements["readBack"] = copyRadiance(again) == before &&
                               vtkSlicerFenestraLogic::GetNumberOfFrames(lastRender()) == frames;
  for (const char* subject : {"VolumeBox", "SegmentationBox"})
    if (!m_panel->findChild<qMRMLNodeComboBox*>(subject)->currentNode())
      return false;
  m_panel->findChild<qMRMLNodeComboBox*>("RendersBox")->setCurrentNode(again);
  wait(2000);
  takeScreenshot("9-reloaded");
  const int ended = m_ended;
  if (!click("RepeatButton") || !waitFor([&] { return m_ended > ended; }, 300000))
    return false;
  wait(2000);
  takeScreenshot("10-repeated");
  m_measurements["repeatedBitForBit"] = copyRadiance(lastRender()) == before;
  return m_measurements["repeatedBitForBit"].toBool() && m_measurements["readBack"].toBool();
}

/// Runs the renderer as a command line module, in the panel that Slicer builds from its XML.
bool qSlicerFenestraTour::runCommand() {
  auto* application = qSlicerApplication::application();
  auto* module =
      dynamic_cast<qSlicerCLIModule*>(application->moduleManager()->module("FenestraCommand"));
  if (!module)
    return false;
  vtkMRMLScene* scene = application->mrmlScene();
  vtkMRMLCommandLineModuleNode* node =
      vtkSlicerCLIModuleLogic::SafeDownCast(module->logic())->CreateNodeInScene();
  auto* output = vtkMRMLVolumeNode::SafeDownCast(
      scene->AddNewNodeByClass("vtkMRMLVectorVolumeNode", "Knee by the command line"));
  node->SetParameterAsNode("inputVolume", scene->GetFirstNodeByName("knee"));
  node->SetParameterAsNode("segmentation", scene->GetFirstNodeByClass("vtkMRMLSegmentationNode"));
  node->SetParameterAsString("focus", "Femoral cartilage");
  node->SetParameterAsString("transfer", "mr-knee");
  node->SetParameterAsString("boundary", "exact");
  node->SetParameterAsNode("output", output);
  node->SetParameterAsInt("samples", 16);
  node->SetParameterAsString("size", "512x512");
  m_window->findChild<qSlicerModuleSelectorToolBar*>()->selectModule("FenestraCommand");
  wait(500);
  auto* panel = m_window->findChild<qSlicerCLIModuleWidget*>();
  if (!panel)
    return false;
  panel->setCurrentCommandLineModuleNode(node);
  wait(500);
  auto* apply = panel->findChild<QAbstractButton*>("ApplyPushButton");
  if (!apply || !apply->isEnabled())
    return false;
  QTest::mouseClick(apply, Qt::LeftButton);
  const auto isCompleted = [node] {
    return !node->IsBusy() && (node->GetStatus() & vtkMRMLCommandLineModuleNode::Completed) != 0;
  };
  if (!waitFor(isCompleted, 300000))
    return false;
  wait(1000);
  alignViewWithOutput(output);
  wait(1000);
  takeScreenshot("11-command");
  m_measurements["commandLineModule"] = node->GetStatusString();
  vtkImageData* image = output->GetImageData();
  return node->GetStatus() == vtkMRMLCommandLineModuleNode::Completed &&
         node->GetErrorText().empty() && image && image->GetDimensions()[0] == 512;
}

/// Rotates the slice view like its menu: first to coronal, then to the image's plane. Hides segment
/// outlines.
void qSlicerFenestraTour::alignViewWithOutput(vtkMRMLVolumeNode* output) {
  auto* application = qSlicerApplication::application();
  std::vector<vtkMRMLNode*> outlines;
  application->mrmlScene()->GetNodesByClass("vtkMRMLSegmentationDisplayNode", outlines);
  for (vtkMRMLNode* outline : outlines)
    vtkMRMLDisplayNode::SafeDownCast(outline)->SetVisibility2D(false);
  auto* slice = vtkMRMLSliceNode::SafeDownCast(
      application->mrmlScene()->GetSingletonNode("Fenestra", "vtkMRMLSliceNode"));
  vtkMRMLSliceLogic* view = application->applicationLogic()->GetSliceLogic(slice);
  if (!view)
    return;
  view->GetSliceCompositeNode()->SetBackgroundVolumeID(output->GetID());
  slice->SetOrientation("Coronal");
  slice->RotateToVolumePlane(output);
  view->FitSliceToBackground(slice->GetDimensions()[0], slice->GetDimensions()[1]);
}
