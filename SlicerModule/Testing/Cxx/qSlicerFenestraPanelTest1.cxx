// The panel at first sight: what is open, what is gray and why, and names for screen readers.
// Arguments: the renderer, a folder for files, the module's library.

#include "FenestraPanel.h"
#include "FenestraTesting.h"

#include <ctkCollapsibleButton.h>

#include <QAbstractButton>
#include <QAbstractSlider>
#include <QAccessible>
#include <QLineEdit>
#include <QListWidget>
#include <QProcess>
#include <QProgressBar>
#include <QRegularExpression>
#include <QSpinBox>
#include <QTableWidget>

namespace {

using FenestraTesting::endsOneRender;
using FenestraTesting::Panel;
using FenestraTesting::waitFor;

/// The sections that a first image does not need are closed.
int checkSections(const Panel& panel) {
  for (const char* open : {"WhatToShow", "ClippingSection"})
    CHECK_BOOL(panel.find<ctkCollapsibleButton>(open)->collapsed(), false);
  for (const char* closed : {"Materials", "ViewAndLight", "Quality", "Turntable", "Images"})
    CHECK_BOOL(panel.find<ctkCollapsibleButton>(closed)->collapsed(), true);
  std::cout << "height of the panel: " << panel.widget->sizeHint().height() << '\n';
  CHECK_BOOL(panel.widget->sizeHint().height() < 1000, true);
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

/// The list shows all of a few segments without scrolling, then grows no further.
int checkList(const Panel& panel, vtkSegmentation* segments) {
  const QListWidget& list = *panel.find<QListWidget>("FocusList");
  const auto countVisible = [&list] { return list.height() / list.sizeHintForRow(0); };
  while (segments->GetNumberOfSegments() < 10)
    segments->AddEmptySegment();
  CHECK_INT(list.count(), 10);
  CHECK_INT(countVisible(), 10);
  while (segments->GetNumberOfSegments() < 40)
    segments->AddEmptySegment();
  CHECK_INT(countVisible(), 12);
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
  FenestraTesting::addVolume(scene);
  vtkMRMLSegmentationNode* segmentation = FenestraTesting::addSegmentation(scene);
  panel.widget->exit();
  panel.widget->enter();
  CHECK_EXIT_SUCCESS(checkSections(panel));
  CHECK_EXIT_SUCCESS(checkReasons(panel));
  CHECK_EXIT_SUCCESS(checkFilter(panel));
  CHECK_EXIT_SUCCESS(checkNames<QAbstractButton>(panel));
  CHECK_EXIT_SUCCESS(checkNames<QAbstractSlider>(panel));
  CHECK_EXIT_SUCCESS(checkNames<QAbstractSpinBox>(panel));
  CHECK_EXIT_SUCCESS(checkNames<QComboBox>(panel));
  CHECK_EXIT_SUCCESS(checkNames<QLineEdit>(panel));
  CHECK_EXIT_SUCCESS(checkNames<QListWidget>(panel));
  CHECK_EXIT_SUCCESS(checkNames<QTableWidget>(panel));
  panel.choose("ViewBox", "left");
  CHECK_EXIT_SUCCESS(checkReasons(panel));
  panel.find<QSpinBox>("SamplesBox")->setValue(1);
  panel.find<QSpinBox>("WidthBox")->setValue(16);
  panel.find<QSpinBox>("HeightBox")->setValue(16);
  auto* button = panel.find<QAbstractButton>("RenderButton");
  CHECK_BOOL(endsOneRender(panel, [&] { button->click(); }), true);
  CHECK_BOOL(panel.find<ctkCollapsibleButton>("Images")->collapsed(), false);
  CHECK_EXIT_SUCCESS(checkList(panel, segmentation->GetSegmentation()));
  scene->Clear(false);
  CHECK_EXIT_SUCCESS(checkSample(panel));
  panel.widget->exit();
  return EXIT_SUCCESS;
}
