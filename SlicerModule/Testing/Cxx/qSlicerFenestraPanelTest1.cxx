// The panel at first sight: what is open, what is gray and why, and names for screen readers.
// Arguments: the renderer, a folder for files, the module's library.

#include "FenestraPanel.h"
#include "FenestraTesting.h"

#include <ctkCollapsibleButton.h>
#include <ctkSliderWidget.h>
#include <qSlicerStyle.h>

#include <QAbstractButton>
#include <QAbstractSlider>
#include <QAccessible>
#include <QKeySequence>
#include <QLabel>
#include <QLineEdit>
#include <QListWidget>
#include <QProcess>
#include <QProgressBar>
#include <QPushButton>
#include <QRegularExpression>
#include <QSet>
#include <QSpinBox>
#include <QTableWidget>

namespace {

using FenestraTesting::endsOneRender;
using FenestraTesting::Panel;
using FenestraTesting::waitFor;
using Node = vtkMRMLFenestraRenderNode;

/// The sections that a first image does not need are closed.
int checkSections(const Panel& panel) {
  CHECK_BOOL(panel.find<ctkCollapsibleButton>("WhatToShow")->collapsed(), false);
  for (const char* closed :
       {"ClippingSection", "Materials", "ViewAndLight", "Quality", "Turntable", "Images"})
    CHECK_BOOL(panel.find<ctkCollapsibleButton>(closed)->collapsed(), true);
  return EXIT_SUCCESS;
}

/// What a first image needs is visible without scrolling, with ten segments and the preview.
int checkHeight(const Panel& panel) {
  constexpr int available = 715 - 40; // pixels, without the section Help & Acknowledgement
  auto* preview = panel.find<QLabel>("PreviewLabel");
  CHECK_BOOL(waitFor([&] { return !preview->pixmap(Qt::ReturnByValue).isNull(); }), true);
  QFont font = panel.widget->font();
  font.setPixelSize(12); // Slicer's on a screen of 96 dots per inch
  qSlicerApplication::application()->setFont(font);
  qSlicerApplication::application()->setStyle(new qSlicerStyle);
  panel.widget->resize(420, available);
  panel.widget->show();
  QCoreApplication::processEvents();
  CHECK_BOOL(preview->height() >= 150, true);
  for (const char* name :
       {"OpenButton", "PhotorealisticButton", "PreviewLabel", "RenderButton", "StopButton",
        "StateLabel", "VolumeBox", "SegmentationBox", "FocusList", "QualityBox", "SizeBox"}) {
    const auto* one = panel.find<QWidget>(name);
    const int bottom = one->mapTo(panel.widget, one->rect().bottomLeft()).y();
    std::cout << name << ": bottom at " << bottom << '\n';
    CHECK_BOOL(one->isVisible() && bottom < available, true);
  }
  return EXIT_SUCCESS;
}

/// Tab goes from top to bottom. The main buttons have keys of their own, which Slicer's menus
/// leave.
int checkKeyboard(const Panel& panel) {
  QSet<QKeySequence> keys = {QKeySequence("Alt+F"), QKeySequence("Alt+E"), QKeySequence("Alt+V"),
                             QKeySequence("Alt+H"), QKeySequence()};
  for (const char* name : {"OpenButton", "PhotorealisticButton", "RenderButton", "StopButton"}) {
    const QKeySequence key = panel.find<QAbstractButton>(name)->shortcut();
    CHECK_BOOL(keys.contains(key), false);
    keys.insert(key);
  }
  const auto isReached = [&panel](const QWidget* one) {
    return panel.widget->isAncestorOf(one) && one->isVisible() && one->isEnabled() &&
           (one->focusPolicy() & Qt::TabFocus) != 0;
  };
  int top = 0, count = 0;
  for (QWidget* one = panel.widget->nextInFocusChain(); one != panel.widget;
       one = one->nextInFocusChain()) {
    if (!isReached(one))
      continue;
    const int y = one->mapTo(panel.widget, QPoint(0, 0)).y();
    if (y + one->height() < top) {
      std::cerr << one->objectName().toStdString() << " comes too late\n";
      return EXIT_FAILURE;
    }
    top = y;
    ++count;
  }
  CHECK_BOOL(count > 12, true);
  return EXIT_SUCCESS;
}

/// A disabled control says what enables it.
int checkReasons(const Panel& panel) {
  int disabled = 0;
  for (const QWidget* one : panel.widget->findChildren<QWidget*>()) {
    const bool isControl = one->focusPolicy() != Qt::NoFocus && !one->objectName().isEmpty() &&
                           !one->objectName().startsWith("qt_");
    if (!isControl || !one->testAttribute(Qt::WA_ForceDisabled))
      continue;
    ++disabled;
    const QVariant help = one->property("FenestraHelp"); // tool tip of the enabled control
    if (!help.isValid() || one->toolTip().isEmpty() || one->toolTip() == help.toString()) {
      std::cerr << one->objectName().toStdString() << " is gray without a reason\n";
      return EXIT_FAILURE;
    }
  }
  CHECK_BOOL(disabled >= 5, true);
  return EXIT_SUCCESS;
}

template <typename Control>
int checkNames(const Panel& panel) {
  for (Control* one : panel.widget->findChildren<Control*>()) {
    QAccessibleInterface* interface = QAccessible::queryAccessibleInterface(one);
    const bool isPart = one->objectName().startsWith("qt_"); // the text of a number
    if (!isPart && one->focusPolicy() != Qt::NoFocus &&
        interface->text(QAccessible::Name).isEmpty()) {
      std::cerr << one->metaObject()->className() << ' ' << one->objectName().toStdString()
                << " in " << one->parentWidget()->objectName().toStdString() << " has no name\n";
      return EXIT_FAILURE;
    }
  }
  return EXIT_SUCCESS;
}

/// The renderer, which the module is installed with, accepts the choices of the panel.
int checkChoices(const Panel& panel, const QString& program) {
  QProcess child;
  child.start(program, {"--xml"});
  CHECK_BOOL(child.waitForFinished(60000), true);
  const QString description = child.readAllStandardOutput();
  const std::map<QString, const char*> boxes = {{"preset", "PresetBox"},     {"clip", "ClipBox"},
                                                {"boundary", "BoundaryBox"}, {"hole", "HoleBox"},
                                                {"view", "ViewBox"},         {"lights", "RigBox"},
                                                {"tone", "ToneBox"}};
  for (const auto& [flag, name] : boxes) {
    const QString text =
        description.section("<name>" + flag + "</name>", 1).section("<name>", 0, 0);
    const auto* box = panel.find<QComboBox>(name);
    for (int i = 0; i < box->count(); ++i) {
      const QString word = box->itemData(i).toString();
      if (!text.contains(QRegularExpression("\\b" + word + "\\b"))) {
        std::cerr << flag.toStdString() << " has no value " << word.toStdString() << '\n';
        return EXIT_FAILURE;
      }
    }
  }
  return EXIT_SUCCESS;
}

/// The list shows a few segments without scrolling, then grows no further.
int checkList(const Panel& panel, vtkSegmentation* segments) {
  const QListWidget& list = *panel.find<QListWidget>("FocusList");
  const auto countVisible = [&list] { return list.height() / list.sizeHintForRow(0); };
  while (segments->GetNumberOfSegments() < 5)
    segments->AddEmptySegment();
  CHECK_INT(list.count(), 5);
  CHECK_INT(countVisible(), 5);
  while (segments->GetNumberOfSegments() < 10)
    segments->AddEmptySegment();
  CHECK_INT(countVisible(), 6);
  return EXIT_SUCCESS;
}

/// The filter hides segments in the list, and leaves the focus unchanged.
int checkFilter(const Panel& panel) {
  QListWidget& list = *panel.find<QListWidget>("FocusList");
  CHECK_INT(list.count(), 2);
  list.item(0)->setCheckState(Qt::Checked);
  const std::vector<std::string> focus = panel.settings()->GetFocus();
  CHECK_INT(static_cast<int>(focus.size()), 1);
  auto* filter = panel.find<QLineEdit>("FocusFilter");
  filter->setText("NOTH");
  CHECK_BOOL(list.item(0)->isHidden(), true);
  CHECK_BOOL(list.item(1)->isHidden(), false);
  list.item(1)->setCheckState(Qt::Checked); // writes the focus
  list.item(1)->setCheckState(Qt::Unchecked);
  CHECK_BOOL(panel.settings()->GetFocus() == focus, true);
  CHECK_BOOL(list.item(0)->isHidden(), true);
  filter->clear();
  CHECK_BOOL(list.item(0)->isHidden(), false);
  return EXIT_SUCCESS;
}

/// The size is one of the list, a typed one, or that of the 3D view. These tests have no 3D view.
int checkSize(const Panel& panel) {
  CHECK_STD_STRING(panel.chosen("SizeBox").toStdString(), "1");
  panel.choose("SizeBox", "1920x1080");
  CHECK_STD_STRING(panel.flag("size"), "1920x1080");
  CHECK_INT(panel.find<QSpinBox>("WidthBox")->value(), 1920);
  panel.find<QSpinBox>("WidthBox")->setValue(48);
  CHECK_STD_STRING(panel.chosen("SizeBox").toStdString(), "");
  panel.find<QSpinBox>("HeightBox")->setValue(40);
  const auto viewSize = [&panel] {
    return panel.settings()->GetAttribute(Node::ViewSizeAttribute);
  };
  CHECK_NULL(viewSize());
  panel.choose("SizeBox", "2");
  CHECK_STRING(viewSize(), "2 48x40");
  CHECK_STD_STRING(panel.flag("size"), "48x40");
  panel.settings()->SetFlag("size", "512x512"); // by a script
  CHECK_STD_STRING(panel.chosen("SizeBox").toStdString(), "512x512");
  panel.settings()->SetFlag("size", "48x40");
  CHECK_STD_STRING(panel.chosen("SizeBox").toStdString(), "2");
  panel.choose("SizeBox", "");
  CHECK_NULL(viewSize());
  return EXIT_SUCCESS;
}

/// Volume, segmentation and focus stay; all else is as in a new scene, also what a widget
/// remembers.
int checkReset(const Panel& panel, vtkMRMLNode* volume, vtkMRMLNode* segmentation) {
  const std::string focus = panel.flag("focus");
  CHECK_BOOL(focus.empty(), false);
  panel.choose("ClipBox", "cutaway");
  panel.set("softBox", 3.0);
  panel.choose("TransferBox", "ct-soft");
  panel.choose("RigBox", "cinema");
  panel.find<ctkSliderWidget>("Strength0")->setValue(50.0);
  panel.choose("QualityBox", "4096 0.015 0");
  panel.find<QSpinBox>("FramesBox")->setValue(7);
  panel.find<QPushButton>("ResetButton")->click();
  vtkNew<Node> defaults;
  vtkSlicerFenestraLogic::ResetSettings(defaults);
  std::map<std::string, std::string> expected = defaults->GetFlags();
  expected["focus"] = focus;
  CHECK_BOOL(panel.settings()->GetFlags() == expected, true);
  CHECK_POINTER(panel.nodes("VolumeBox")->currentNode(), volume);
  CHECK_POINTER(panel.nodes("SegmentationBox")->currentNode(), segmentation);
  for (const auto& [box, data] :
       {std::pair("ClipBox", ""), std::pair("TransferBox", ""), std::pair("RigBox", ""),
        std::pair("ViewBox", ""), std::pair("QualityBox", "256 0.05 0"), std::pair("SizeBox", "1")})
    CHECK_STD_STRING(panel.chosen(box).toStdString(), std::string(data));
  CHECK_INT(panel.find<QSpinBox>("FramesBox")->value(), 36);
  panel.find<QSpinBox>("SamplesBox")->setValue(255); // writes all flags of the panel
  for (const char* usual : {"transfer", "lights", "soft", "clip", "steady"})
    CHECK_STD_STRING(panel.flag(usual), "");
  CHECK_DOUBLE(panel.find<ctkSliderWidget>("Strength0")->value(), 100.0);
  return EXIT_SUCCESS;
}

/// The click itself shows that the sample is being generated.
int checkSample(const Panel& panel) {
  auto* sample = panel.find<QAbstractButton>("SampleButton");
  auto* progress = panel.find<QProgressBar>("ProgressBar");
  CHECK_BOOL(progress->isHidden(), true);
  sample->click();
  CHECK_BOOL(progress->isHidden(), false);
  CHECK_INT(progress->maximum(), 0); // busy
  CHECK_BOOL(sample->isEnabled(), false);
  const auto isReady = [&] { return sample->isEnabled(); };
  for (int i = 0; i < 6 && !isReady(); ++i) // slow on a busy machine
    waitFor(isReady);
  CHECK_BOOL(isReady(), true);
  CHECK_BOOL(progress->isHidden(), true);
  CHECK_INT(progress->maximum(), 1000);
  return EXIT_SUCCESS;
}

} // namespace

int qSlicerFenestraPanelTest1(int argc, char* argv[]) {
  const FenestraTesting::Slicer slicer(argc, argv);
  const Panel& panel = slicer.panel;
  vtkMRMLScene* scene = slicer.scene;
  panel.widget->enter();
  CHECK_EXIT_SUCCESS(checkChoices(panel, argv[1]));
  CHECK_EXIT_SUCCESS(checkSections(panel));
  CHECK_EXIT_SUCCESS(checkReasons(panel));
  vtkMRMLNode* const volume = FenestraTesting::addVolume(scene);
  vtkMRMLSegmentationNode* segmentation = FenestraTesting::addSegmentation(scene);
  panel.widget->exit();
  panel.widget->enter();
  CHECK_EXIT_SUCCESS(checkSections(panel));
  CHECK_EXIT_SUCCESS(checkReasons(panel));
  CHECK_EXIT_SUCCESS(checkFilter(panel));
  CHECK_EXIT_SUCCESS(checkSize(panel));
  CHECK_EXIT_SUCCESS(checkReset(panel, volume, segmentation));
  CHECK_EXIT_SUCCESS(checkNames<QAbstractButton>(panel));
  CHECK_EXIT_SUCCESS(checkNames<QAbstractSlider>(panel));
  CHECK_EXIT_SUCCESS(checkNames<QAbstractSpinBox>(panel));
  CHECK_EXIT_SUCCESS(checkNames<QComboBox>(panel));
  CHECK_EXIT_SUCCESS(checkNames<QLineEdit>(panel));
  CHECK_EXIT_SUCCESS(checkNames<QListWidget>(panel));
  CHECK_EXIT_SUCCESS(checkNames<QTableWidget>(panel));
  CHECK_EXIT_SUCCESS(checkList(panel, segmentation->GetSegmentation()));
  CHECK_EXIT_SUCCESS(checkHeight(panel));
  CHECK_EXIT_SUCCESS(checkKeyboard(panel));
  panel.choose("ViewBox", "left");
  CHECK_EXIT_SUCCESS(checkReasons(panel));
  panel.find<QSpinBox>("SamplesBox")->setValue(1);
  panel.find<QSpinBox>("WidthBox")->setValue(16);
  panel.find<QSpinBox>("HeightBox")->setValue(16);
  auto* button = panel.find<QAbstractButton>("RenderButton");
  CHECK_BOOL(endsOneRender(panel, [&] { button->click(); }), true);
  CHECK_BOOL(panel.find<ctkCollapsibleButton>("Images")->collapsed(), false);
  scene->Clear(false);
  CHECK_EXIT_SUCCESS(checkSample(panel));
  panel.widget->exit();
  return EXIT_SUCCESS;
}
