// The panel as a user meets it: its widgets are used, and what they say is compared with the node
// of settings, both ways. Arguments: the renderer, a folder for files, the module's library.

#include "FenestraTesting.h"

#include "qSlicerFenestraModule.h"
#include "qSlicerFenestraModuleWidget.h"
#include "vtkMRMLFenestraRenderNode.h"

#include <ctkSliderWidget.h>
#include <qMRMLNodeComboBox.h>
#include <qSlicerApplication.h>

#include <QCheckBox>
#include <QComboBox>
#include <QElapsedTimer>
#include <QLabel>
#include <QListWidget>
#include <QPushButton>
#include <QScopedPointer>
#include <QSpinBox>

#include <vtkMRMLVectorVolumeNode.h>

namespace {

using Node = vtkMRMLFenestraRenderNode;

struct Panel {
  qSlicerFenestraModuleWidget* widget;
  vtkSlicerFenestraLogic* logic;

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
  Node* picture() const { return Node::SafeDownCast(nodes("RendersBox")->currentNode()); }
  qMRMLNodeComboBox* nodes(const char* name) const { return find<qMRMLNodeComboBox>(name); }
};

/// Whether a render ended after what is done.
template <typename Action>
bool ends(const Panel& panel, Action&& action) {
  int ended = 0;
  QElapsedTimer watch;
  watch.start();
  const auto connection = QObject::connect(panel.widget->session(), &qSlicerFenestraSession::ended,
                                           panel.widget, [&] { ++ended; });
  action();
  while (ended == 0 && watch.elapsed() < 30000)
    QCoreApplication::processEvents(QEventLoop::AllEvents | QEventLoop::WaitForMoreEvents, 10);
  QObject::disconnect(connection);
  return ended == 1;
}

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
  return EXIT_SUCCESS;
}

/// What the user chooses is in the node.
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
  panel.find<ctkSliderWidget>("Strength0")->setValue(50.0);
  CHECK_BOOL(panel.settings()->GetFlag("lights").front() == '{', true);
  panel.choose("RigBox", "soft");
  panel.find<ctkSliderWidget>("Strength0")->setValue(100.0);
  CHECK_STD_STRING(panel.settings()->GetFlag("lights"), "soft");
  return EXIT_SUCCESS;
}

/// What the node says is shown, and no more than that is changed by showing it.
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

int checkRenders(const Panel& panel) {
  auto* button = panel.find<QPushButton>("RenderButton");
  CHECK_BOOL(ends(panel, [&] { button->click(); }), true);
  Node* first = panel.picture();
  CHECK_NOT_NULL(first);
  CHECK_BOOL(panel.find<QLabel>("StateLabel")->text().startsWith("Done: "), true);
  CHECK_BOOL(panel.find<QLabel>("DescriptionLabel")->text().contains("samples"), true);
  for (const char* enabled : {"ShowButton", "RepeatButton", "SaveButton"})
    CHECK_BOOL(panel.find<QPushButton>(enabled)->isEnabled(), true);
  CHECK_BOOL(panel.find<QPushButton>("StopButton")->isEnabled(), false);

  // Other settings, and back to the first ones by Repeat.
  panel.choose("ViewBox", "anterior");
  panel.choose("RigBox", "studio");
  CHECK_BOOL(ends(panel, [&] { panel.find<QPushButton>("RepeatButton")->click(); }), true);
  CHECK_STD_STRING(panel.settings()->GetFlag("view"), "left");
  CHECK_STD_STRING(panel.chosen("RigBox").toStdString(), "soft");
  CHECK_BOOL(panel.picture() != first, true);
  CHECK_BOOL(radianceOf(first).isEmpty(), false);
  CHECK_BOOL(radianceOf(panel.picture()) == radianceOf(first), true);

  // A segment without a voxel: a sentence, and the picture from before stays chosen.
  QListWidget& focus = *panel.find<QListWidget>("FocusList");
  focus.item(0)->setCheckState(Qt::Unchecked);
  focus.item(1)->setCheckState(Qt::Checked);
  Node* const before = panel.picture();
  CHECK_BOOL(ends(panel, [&] { button->click(); }), true);
  CHECK_BOOL(panel.find<QLabel>("StateLabel")->text().contains("choose segments"), true);
  CHECK_POINTER(panel.picture(), before);
  return EXIT_SUCCESS;
}

} // namespace

int qSlicerFenestraModuleWidgetTest1(int argc, char* argv[]) {
  qSlicerApplication application(argc, argv);
  if (argc < 4)
    return EXIT_FAILURE;
  qSlicerFenestraModule module;
  module.setName("Fenestra");
  module.setPath(argv[3]);
  module.initialize(application.applicationLogic());
  vtkMRMLScene* scene = application.mrmlScene();
  module.setMRMLScene(scene);
  auto* widget = dynamic_cast<qSlicerFenestraModuleWidget*>(module.widgetRepresentation());
  CHECK_NOT_NULL(widget);
  const QScopedPointer<qSlicerFenestraModuleWidget> owner(widget);
  const Panel panel{widget, vtkSlicerFenestraLogic::SafeDownCast(module.logic())};
  widget->enter();
  CHECK_EXIT_SUCCESS(checkEmpty(panel));
  widget->exit();

  vtkMRMLNode* volume = FenestraTesting::addVolume(scene);
  vtkMRMLSegmentationNode* segmentation = FenestraTesting::addSegmentation(scene);
  widget->enter();
  CHECK_EXIT_SUCCESS(checkDefaults(panel, volume, segmentation));
  CHECK_EXIT_SUCCESS(checkTaking(panel, segmentation->GetSegmentation()->GetNthSegmentID(0)));
  CHECK_EXIT_SUCCESS(checkShowing(panel));
  CHECK_EXIT_SUCCESS(checkRenders(panel));

  // A segment added, renamed and removed elsewhere; then another segmentation.
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
  widget->exit();
  return EXIT_SUCCESS;
}
