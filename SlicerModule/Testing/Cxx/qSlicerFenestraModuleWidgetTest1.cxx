// The panel as a user operates it: widgets and settings node stay equal, in both directions.
// Arguments: the renderer, a folder for files, the module's library.

#include "FenestraPanel.h"
#include "FenestraTesting.h"

#include <ctkSliderWidget.h>

#include <QCheckBox>
#include <QLabel>
#include <QListWidget>
#include <QPushButton>
#include <QSlider>
#include <QSpinBox>
#include <QToolButton>

#include <vtkMRMLMarkupsPlaneNode.h>
#include <vtkMRMLSliceCompositeNode.h>
#include <vtkMRMLVectorVolumeNode.h>

namespace {

using FenestraTesting::endsOneRender;
using FenestraTesting::Panel;
using FenestraTesting::waitFor;
using Node = vtkMRMLFenestraRenderNode;

QByteArray radianceOf(Node* render) {
  auto* volume =
      vtkMRMLVectorVolumeNode::SafeDownCast(render->GetNodeReference(Node::RadianceRole));
  if (!volume)
    return {};
  vtkImageData* image = volume->GetImageData();
  return {static_cast<const char*>(image->GetScalarPointer()),
          static_cast<int>(image->GetNumberOfPoints()) * 16};
}

int checkEmpty(const Panel& panel) {
  CHECK_BOOL(panel.find<QPushButton>("RenderButton")->isEnabled(), false);
  CHECK_BOOL(panel.find<QPushButton>("SampleButton")->isHidden(), false);
  CHECK_INT(panel.find<QListWidget>("FocusList")->count(), 0);
  for (const char* button : {"ShowButton", "RepeatButton", "SaveButton", "StopButton"})
    CHECK_BOOL(panel.find<QPushButton>(button)->isEnabled(), false);
  return EXIT_SUCCESS;
}

int checkDefaults(const Panel& panel, vtkMRMLNode* volume, vtkMRMLNode* segmentation) {
  CHECK_POINTER(panel.nodes("VolumeBox")->currentNode(), volume);
  CHECK_POINTER(panel.nodes("SegmentationBox")->currentNode(), segmentation);
  CHECK_BOOL(panel.find<QPushButton>("RenderButton")->isEnabled(), true);
  CHECK_BOOL(panel.find<QPushButton>("SampleButton")->isHidden(), true);
  CHECK_INT(panel.find<QListWidget>("FocusList")->count(), 2);
  CHECK_STD_STRING(panel.chosen("QualityBox").toStdString(), "256 0.05 0");
  panel.find<QSpinBox>("SamplesBox")->setValue(255); // writes all flags of the panel
  for (const char* usual : {"transfer", "lights", "exposure", "tone", "preset", "clip"})
    CHECK_STD_STRING(panel.flag(usual), "");
  CHECK_STD_STRING(panel.flag("background"), "dark");
  return EXIT_SUCCESS;
}

/// Slice views show the newest volume on request, since loading a scene does not change them.
int checkShowingVolume(const Panel& panel, vtkMRMLScene* scene, vtkMRMLNode* volume) {
  auto* view = vtkMRMLSliceCompositeNode::SafeDownCast(
      scene->AddNewNodeByClass("vtkMRMLSliceCompositeNode"));
  panel.logic->ShowNewestVolume();
  CHECK_STRING(view->GetBackgroundVolumeID(), volume->GetID());
  scene->RemoveNode(view);
  return EXIT_SUCCESS;
}

/// The user's choices are stored in the node.
int checkTaking(const Panel& panel, const std::string& segment) {
  panel.find<QListWidget>("FocusList")->item(0)->setCheckState(Qt::Checked);
  CHECK_INT(static_cast<int>(panel.settings()->GetFocus().size()), 1);
  CHECK_STD_STRING(panel.settings()->GetFocus().front(), segment);
  panel.choose("ClipBox", "cutaway");
  CHECK_STD_STRING(panel.settings()->GetFlag("clip"), "cutaway");
  panel.choose("ViewBox", "left");
  CHECK_STD_STRING(panel.settings()->GetFlag("view"), "left");
  CHECK_BOOL(panel.find<QCheckBox>("FollowBox")->isEnabled(), false);
  panel.choose("TransferBox", "ct-soft");
  CHECK_STD_STRING(panel.settings()->GetFlag("transfer"), "ct-soft");
  panel.choose("QualityBox", "16 0 0");
  CHECK_STD_STRING(panel.settings()->GetFlag("samples"), "16");
  CHECK_STD_STRING(panel.settings()->GetFlag("noise"), "");
  panel.find<QSpinBox>("SamplesBox")->setValue(8);
  CHECK_STD_STRING(panel.settings()->GetFlag("samples"), "8");
  CHECK_STD_STRING(panel.chosen("QualityBox").toStdString(), ""); // custom
  panel.find<QSpinBox>("WidthBox")->setValue(48);
  panel.find<QSpinBox>("HeightBox")->setValue(40);
  CHECK_STD_STRING(panel.settings()->GetFlag("size"), "48x40");
  panel.set("ExposureBox", 0.5);
  CHECK_STD_STRING(panel.flag("exposure"), "0.5");
  panel.choose("RigBox", "cinema");
  panel.find<ctkSliderWidget>("Strength0")->setValue(50.0);
  CHECK_BOOL(panel.settings()->GetFlag("lights").front() == '{', true);
  panel.choose("RigBox", "soft");
  panel.find<ctkSliderWidget>("Strength0")->setValue(100.0);
  CHECK_STD_STRING(panel.settings()->GetFlag("lights"), "soft");
  return EXIT_SUCCESS;
}

/// The panel shows the node's flags without changing other flags.
int checkShowing(const Panel& panel) {
  Node* settings = panel.settings();
  const std::map<std::string, std::string> before = settings->GetFlags();
  std::map<std::string, std::string> flags = before;
  flags["view"] = "superior";
  flags["clip"] = "none";
  flags["samples"] = "4096";
  flags["noise"] = "0.015";
  flags["size"] = "300x200";
  settings->SetFlags(flags);
  CHECK_BOOL(settings->GetFlags() == flags, true);
  CHECK_STD_STRING(panel.chosen("ViewBox").toStdString(), "superior");
  CHECK_STD_STRING(panel.chosen("ClipBox").toStdString(), "none");
  CHECK_STD_STRING(panel.chosen("QualityBox").toStdString(), "4096 0.015 0");
  CHECK_INT(panel.find<QSpinBox>("WidthBox")->value(), 300);
  CHECK_STD_STRING(panel.chosen("RigBox").toStdString(), "soft");
  settings->SetFlags(before);
  CHECK_STD_STRING(panel.chosen("ViewBox").toStdString(), "left");
  CHECK_BOOL(settings->GetFlags() == before, true);
  return EXIT_SUCCESS;
}

/// Each clip mode shows its own widgets and sets no flags of other modes.
int checkClipping(const Panel& panel) {
  const std::map<std::string, std::string> before = panel.settings()->GetFlags();
  for (const char* automatic : {"labelsmoothing", "soft", "contextsaturation"})
    CHECK_STD_STRING(panel.flag(automatic), ""); // the renderer chooses
  panel.choose("ClipBox", "");
  CHECK_BOOL(panel.isShown("BoundaryBox"), true);
  for (const char* other : {"ghostBox", "HoleBox", "holemarginBox", "PlaneBox", "PlaneNodeBox"})
    CHECK_BOOL(panel.isShown(other), false);
  CHECK_STD_STRING(panel.flag("boundary"), "exact"); // the default of a first focus
  panel.settings()->SetFlag("boundary", "");         // like a scene that Fenestra did not save
  CHECK_STD_STRING(panel.chosen("BoundaryBox").toStdString(), "exact");
  panel.choose("BoundaryBox", "spline");
  panel.settings()->SetFlag("controlpoints", "30");
  panel.set("softBox", 1.0);
  CHECK_STD_STRING(panel.flag("boundary"), "spline"); // other choices keep the boundary
  CHECK_STD_STRING(panel.flag("controlpoints"), "30");
  panel.choose("BoundaryBox", "exact");
  CHECK_STD_STRING(panel.flag("controlpoints"), ""); // used only by the spline
  panel.choose("ClipBox", "ghost");
  CHECK_STD_STRING(panel.flag("boundary"), "exact"); // ghost has the same surface
  panel.set("ghostBox", 25.0);
  CHECK_STD_STRING(panel.flag("ghost"), "0.25");
  panel.choose("ClipBox", "hole");
  CHECK_BOOL(panel.isShown("ghostBox"), false);
  CHECK_BOOL(panel.isShown("BoundaryBox"), false);
  for (const char* other : {"ghost", "boundary", "hole", "holemargin"}) // the renderer's defaults
    CHECK_STD_STRING(panel.flag(other), "");
  panel.choose("HoleBox", "sphere");
  panel.set("holemarginBox", 7.5);
  CHECK_STD_STRING(panel.flag("hole"), "sphere");
  CHECK_STD_STRING(panel.flag("holemargin"), "7.5");
  panel.choose("ClipBox", "ghost"); // values set before are kept
  CHECK_STD_STRING(panel.flag("ghost"), "0.25");
  CHECK_STD_STRING(panel.flag("holemargin"), "");

  panel.set("offsetBox", -2.5);
  panel.set("softBox", 3.0);
  panel.set("labelsmoothingBox", 0.8);
  panel.set("contextdensityBox", 40.0);
  panel.set("contextsaturationBox", 0.0);
  panel.find<QCheckBox>("MarginAutoBox")->setChecked(false);
  CHECK_STD_STRING(panel.flag("margin"), "0");
  panel.set("MarginBox", 1.0);
  const std::map<std::string, std::string> expected = {
      {"offset", "-2.5"},        {"soft", "3"},   {"labelsmoothing", "0.8"},
      {"contextdensity", "0.4"}, {"margin", "1"}, {"contextsaturation", "0"}};
  for (const auto& [name, value] : expected)
    CHECK_STD_STRING(panel.flag(name.c_str()), value);
  panel.choose("ClipBox", "none"); // context styles do not depend on clipping
  CHECK_STD_STRING(panel.flag("offset"), "");
  CHECK_STD_STRING(panel.flag("contextdensity"), "0.4");
  panel.choose("ClipBox", "cutaway");
  CHECK_STD_STRING(panel.flag("offset"), "-2.5");

  // Without a focus, no clipping flag is set.
  QListWidgetItem* segment = panel.find<QListWidget>("FocusList")->item(0);
  panel.set("labelsmoothingBox", 0.0);
  segment->setCheckState(Qt::Unchecked);
  for (const char* name : {"clip", "offset", "margin", "contextdensity", "labelsmoothing"})
    CHECK_STD_STRING(panel.flag(name), "");
  segment->setCheckState(Qt::Checked);
  CHECK_STD_STRING(panel.flag("clip"), "cutaway");
  CHECK_STD_STRING(panel.flag("margin"), "1");
  CHECK_STD_STRING(panel.flag("labelsmoothing"), "0"); // as chosen

  // Digits beyond those of the box are kept until the box changes.
  panel.settings()->SetFlag("soft", "1.23456");
  CHECK_DOUBLE(panel.find<QDoubleSpinBox>("softBox")->value(), 1.23);
  panel.choose("TransferBox", "ct-bone");
  CHECK_STD_STRING(panel.flag("soft"), "1.23456");
  panel.settings()->SetFlags(before);
  CHECK_BOOL(panel.settings()->GetFlags() == before, true);
  return EXIT_SUCCESS;
}

int checkMargins(const Panel& panel) {
  const std::map<std::string, std::string> before = panel.settings()->GetFlags();
  QListWidget& focus = *panel.find<QListWidget>("FocusList");
  CHECK_BOOL(panel.isShown("MarginEachBox"), false);
  focus.item(1)->setCheckState(Qt::Checked);
  CHECK_BOOL(panel.isShown("MarginEachBox"), true);
  CHECK_BOOL(panel.isShown("Margin1"), false);
  panel.find<QCheckBox>("MarginAutoBox")->setChecked(false);
  panel.find<QCheckBox>("MarginEachBox")->setChecked(true);
  panel.set("Margin0", 1.5);
  panel.set("Margin1", -0.5);
  CHECK_STD_STRING(panel.flag("margin"), "1.5,-0.5");
  panel.settings()->SetFlag("margin", "2,3");
  CHECK_DOUBLE(panel.find<QDoubleSpinBox>("Margin1")->value(), 3.0);
  panel.settings()->SetFlag("margin", "4");
  CHECK_BOOL(panel.find<QCheckBox>("MarginEachBox")->isChecked(), false);
  CHECK_DOUBLE(panel.find<QDoubleSpinBox>("MarginBox")->value(), 4.0);
  panel.settings()->SetFlag("margin", "auto");
  CHECK_BOOL(panel.find<QCheckBox>("MarginAutoBox")->isChecked(), true);
  panel.settings()->SetFlags(before);
  return EXIT_SUCCESS;
}

int checkPlane(const Panel& panel, vtkMRMLScene* scene) {
  const std::map<std::string, std::string> before = panel.settings()->GetFlags();
  panel.choose("ClipBox", "plane");
  CHECK_STD_STRING(panel.flag("clip"), "plane");
  CHECK_STD_STRING(panel.flag("plane"), ""); // placed by the focus
  CHECK_BOOL(panel.isShown("PlaneNodeBox"), false);
  auto* combo = panel.find<QComboBox>("PlaneBox");
  combo->setCurrentIndex(1);
  CHECK_BOOL(panel.isShown("PlaneNodeBox"), true);
  scene->RegisterNodeClass(vtkSmartPointer<vtkMRMLMarkupsPlaneNode>::New());
  auto* plane = vtkMRMLMarkupsPlaneNode::SafeDownCast(
      scene->AddNewNodeByClass("vtkMRMLMarkupsPlaneNode", "Cut"));
  plane->SetOrigin(0.0, 2.0, 0.0);
  plane->SetNormal(0.0, 1.0, 0.0);
  panel.nodes("PlaneNodeBox")->setCurrentNode(plane);
  CHECK_BOOL(FenestraTesting::isNear(panel.flag("plane"), {0, 2, 0, 0, 1, 0}), true);
  plane->SetOrigin(0.0, 4.0, 0.0); // the node is followed
  CHECK_BOOL(FenestraTesting::isNear(panel.flag("plane"), {0, 4, 0, 0, 1, 0}), true);
  panel.settings()->SetNodeReferenceID(Node::PlaneRole, nullptr); // like Repeat
  CHECK_INT(combo->currentIndex(), 2);
  plane->SetOrigin(0.0, 6.0, 0.0);
  CHECK_BOOL(FenestraTesting::isNear(panel.flag("plane"), {0, 4, 0, 0, 1, 0}), true);
  combo->setCurrentIndex(0);
  CHECK_STD_STRING(panel.flag("plane"), "");
  CHECK_INT(combo->count(), 2);
  panel.settings()->SetFlags(before);
  scene->RemoveNode(plane);
  return EXIT_SUCCESS;
}

/// The automatic view needs a focus, and a preset replaces the flags that it sets.
int checkPresets(const Panel& panel) {
  const std::map<std::string, std::string> before = panel.settings()->GetFlags();
  panel.choose("ViewBox", "auto");
  CHECK_STD_STRING(panel.flag("view"), "auto");
  panel.find<QListWidget>("FocusList")->item(0)->setCheckState(Qt::Unchecked);
  CHECK_STD_STRING(panel.flag("view"), ""); // no focus
  panel.find<QListWidget>("FocusList")->item(0)->setCheckState(Qt::Checked);
  panel.choose("RigBox", "soft");
  panel.choose("PresetBox", "knee-cartilage");
  for (const char* name : {"view", "position", "lights", "transfer", "clip"})
    CHECK_STD_STRING(panel.flag(name), "");
  CHECK_STD_STRING(panel.flag("preset"), "knee-cartilage");
  CHECK_STD_STRING(panel.chosen("ViewBox").toStdString(), "preset");
  panel.choose("ClipBox", "surface"); // overrides the preset
  CHECK_STD_STRING(panel.flag("clip"), "surface");
  panel.choose("ViewBox", "left");
  CHECK_STD_STRING(panel.flag("view"), "left");
  panel.choose("PresetBox", "");
  CHECK_STD_STRING(panel.chosen("RigBox").toStdString(), "");
  CHECK_STD_STRING(panel.flag("clip"), "");
  panel.choose("RigBox", "soft");
  panel.settings()->SetFlags(before);
  CHECK_BOOL(panel.settings()->GetFlags() == before, true);
  return EXIT_SUCCESS;
}

/// The panel shows withheld flags; file names become flags once allowed.
int checkWithheld(const Panel& panel) {
  const std::map<std::string, std::string> flags = panel.settings()->GetFlags();
  CHECK_BOOL(panel.isShown("WithheldLabel"), false);
  const char* attributes[] = {"transfer", "/nowhere/mine.json", "noise", "<b>", nullptr};
  panel.settings()->ReadXMLAttributes(attributes);
  CHECK_BOOL(panel.find<QLabel>("WithheldLabel")->text().contains("transfer: /nowhere"), true);
  CHECK_BOOL(panel.find<QLabel>("WithheldLabel")->text().contains("noise: <b>"), true);
  CHECK_BOOL(panel.isShown("AllowButton"), true);
  CHECK_STD_STRING(panel.flag("transfer"), "");
  panel.find<QPushButton>("AllowButton")->click();
  CHECK_STD_STRING(panel.flag("transfer"), "/nowhere/mine.json");
  CHECK_STD_STRING(panel.chosen("TransferBox").toStdString(), "/nowhere/mine.json");
  CHECK_BOOL(panel.isShown("AllowButton"), false);
  panel.settings()->SetFlag("noise", "0.05"); // removes the last withheld flag
  CHECK_BOOL(panel.isShown("WithheldLabel"), false);
  panel.settings()->SetFlags(flags);
  return EXIT_SUCCESS;
}

/// A turntable is rendered, played, stopped and resumed.
int checkTurntable(const Panel& panel) {
  CHECK_BOOL(panel.isShown("Player"), false);
  auto* frames = panel.find<QSpinBox>("FramesBox");
  auto* turn = panel.find<QPushButton>("TurnButton");
  frames->setValue(3);
  panel.set("DegreesBox", 30.0);
  CHECK_STD_STRING(panel.flag("frames"), "3");
  CHECK_STD_STRING(panel.flag("degrees"), "30");
  CHECK_BOOL(endsOneRender(panel, [&] { turn->click(); }), true);
  Node* turntable = panel.chosenRender();
  CHECK_NOT_NULL(turntable);
  CHECK_BOOL(turntable->IsTurntable(), true);
  CHECK_INT(vtkSlicerFenestraLogic::GetNumberOfFrames(turntable), 3);
  CHECK_BOOL(panel.find<QLabel>("DescriptionLabel")->text().startsWith("3 of 3 frames"), true);
  CHECK_BOOL(panel.isShown("Player"), true);
  CHECK_BOOL(panel.isShown("ResumeButton"), false);
  auto* slider = panel.find<QSlider>("FrameSlider");
  CHECK_INT(slider->maximum(), 2);
  panel.find<QToolButton>("PlayButton")->setChecked(true);
  CHECK_BOOL(waitFor([&] { return slider->value() == 2; }), true);
  CHECK_BOOL(waitFor([&] { return slider->value() == 0; }), true); // loops
  panel.find<QToolButton>("PlayButton")->setChecked(false);

  frames->setValue(60);
  const auto connection =
      QObject::connect(panel.widget->session(), &qSlicerFenestraSession::progressed, panel.widget,
                       [&](Node*, double fraction, double) {
                         if (fraction > 0.1)
                           panel.widget->session()->stop();
                       });
  CHECK_BOOL(endsOneRender(panel, [&] { turn->click(); }), true);
  QObject::disconnect(connection);
  turntable = panel.chosenRender();
  const int some = vtkSlicerFenestraLogic::GetNumberOfFrames(turntable);
  std::cout << some << " frames before the stop\n";
  CHECK_BOOL(some > 0 && some < 60, true);
  CHECK_BOOL(panel.isShown("ResumeButton"), true);
  CHECK_BOOL(endsOneRender(panel, [&] { panel.find<QPushButton>("ResumeButton")->click(); }), true);
  CHECK_POINTER(panel.chosenRender(), turntable);
  CHECK_INT(vtkSlicerFenestraLogic::GetNumberOfFrames(turntable), 60);
  CHECK_INT(slider->maximum(), 59);
  CHECK_BOOL(panel.isShown("ResumeButton"), false);
  return EXIT_SUCCESS;
}

int checkRenders(const Panel& panel) {
  auto* button = panel.find<QPushButton>("RenderButton");
  CHECK_BOOL(endsOneRender(panel, [&] { button->click(); }), true);
  Node* first = panel.chosenRender();
  CHECK_NOT_NULL(first);
  CHECK_BOOL(panel.find<QLabel>("StateLabel")->text().startsWith("Done: "), true);
  CHECK_BOOL(panel.find<QLabel>("DescriptionLabel")->text().contains("samples"), true);
  CHECK_BOOL(panel.isShown("MeasuresLabel"), true);
  CHECK_BOOL(panel.find<QLabel>("MeasuresLabel")->text().contains("Focus visible"), true);
  for (const char* enabled : {"ShowButton", "RepeatButton", "SaveButton"})
    CHECK_BOOL(panel.find<QPushButton>(enabled)->isEnabled(), true);
  CHECK_BOOL(panel.find<QPushButton>("StopButton")->isEnabled(), false);

  // Repeat restores the settings of the first image.
  panel.choose("ViewBox", "anterior");
  panel.choose("RigBox", "studio");
  panel.choose("SizeBox", "2");
  CHECK_BOOL(endsOneRender(panel, [&] { panel.find<QPushButton>("RepeatButton")->click(); }), true);
  CHECK_STD_STRING(panel.settings()->GetFlag("view"), "left");
  CHECK_STD_STRING(panel.chosen("RigBox").toStdString(), "soft");
  CHECK_STD_STRING(panel.chosen("SizeBox").toStdString(), ""); // fixed, whatever the 3D view's is
  CHECK_BOOL(panel.chosenRender() != first, true);
  CHECK_BOOL(radianceOf(first).isEmpty(), false);
  CHECK_BOOL(radianceOf(panel.chosenRender()) == radianceOf(first), true);

  // An empty segment gives a message, and the earlier image stays chosen.
  QListWidget& focus = *panel.find<QListWidget>("FocusList");
  focus.item(0)->setCheckState(Qt::Unchecked);
  focus.item(1)->setCheckState(Qt::Checked);
  Node* const before = panel.chosenRender();
  CHECK_BOOL(endsOneRender(panel, [&] { button->click(); }), true);
  CHECK_BOOL(panel.find<QLabel>("StateLabel")->text().contains("choose segments"), true);
  CHECK_POINTER(panel.chosenRender(), before);
  panel.find<QPushButton>("ShowButton")->click(); // another action clears the message
  CHECK_STD_STRING(panel.find<QLabel>("StateLabel")->text().toStdString(), "");
  return EXIT_SUCCESS;
}

} // namespace

int qSlicerFenestraModuleWidgetTest1(int argc, char* argv[]) {
  const FenestraTesting::Slicer slicer(argc, argv);
  const Panel& panel = slicer.panel;
  vtkMRMLScene* scene = slicer.scene;
  panel.widget->enter();
  CHECK_EXIT_SUCCESS(checkEmpty(panel));
  panel.widget->exit();

  vtkMRMLNode* volume = FenestraTesting::addVolume(scene);
  vtkMRMLSegmentationNode* segmentation = FenestraTesting::addSegmentation(scene);
  panel.widget->enter();
  CHECK_EXIT_SUCCESS(checkDefaults(panel, volume, segmentation));
  CHECK_EXIT_SUCCESS(checkShowingVolume(panel, scene, volume));
  CHECK_EXIT_SUCCESS(checkTaking(panel, segmentation->GetSegmentation()->GetNthSegmentID(0)));
  CHECK_EXIT_SUCCESS(checkShowing(panel));
  CHECK_EXIT_SUCCESS(checkClipping(panel));
  CHECK_EXIT_SUCCESS(checkMargins(panel));
  CHECK_EXIT_SUCCESS(checkPlane(panel, scene));
  CHECK_EXIT_SUCCESS(checkPresets(panel));
  CHECK_EXIT_SUCCESS(checkWithheld(panel));
  CHECK_EXIT_SUCCESS(checkTurntable(panel));
  CHECK_EXIT_SUCCESS(checkRenders(panel));

  // A segment is added and removed outside the panel; then the segmentation is deselected.
  QListWidget& focus = *panel.find<QListWidget>("FocusList");
  segmentation->GetSegmentation()->AddEmptySegment("Third", "Third");
  CHECK_INT(focus.count(), 3);
  segmentation->GetSegmentation()->RemoveSegment("Third");
  CHECK_INT(focus.count(), 2);
  panel.nodes("SegmentationBox")->setCurrentNode(nullptr);
  CHECK_INT(focus.count(), 0);
  CHECK_BOOL(panel.settings()->GetFocus().empty(), true);

  scene->Clear(false);
  CHECK_EXIT_SUCCESS(checkEmpty(panel));
  panel.widget->exit();
  return EXIT_SUCCESS;
}
