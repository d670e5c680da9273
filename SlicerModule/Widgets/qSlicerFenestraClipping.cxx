#include "qSlicerFenestraClipping.h"

#include "qSlicerFenestraMargins.h"
#include "qSlicerFenestraWidgets.h"
#include "ui_qSlicerFenestraClipping.h"

#include <QSignalBlocker>

using namespace qSlicerFenestraWidgets;

namespace {

using Flags = qSlicerFenestraClipping::Flags;
using Plane = qSlicerFenestraClipping::Plane;

constexpr const char* byPresetMode = "preset"; ///< only the renderer knows the preset's mode
const QStringList& cuttingModes() {
  static const QStringList modes = {"surface", "ghost", "cutaway", "hole", "plane", byPresetMode};
  return modes;
}
const QStringList anyMode; ///< empty list: any mode with a focus

/// Widget of a numeric flag. Its value in the .ui file is the default.
struct Number {
  const char* flag;
  QDoubleSpinBox* box;
  double unit;       ///< flag value per unit of the box
  QStringList modes; ///< clip modes that use the flag; empty: all
  double defaultValue = box->value();
  QString shown = {}; ///< flag value last shown; may have more digits than the box
  double shownValue = defaultValue;

  bool isUsed(const QString& mode) const { return modes.isEmpty() || modes.contains(mode); }
};

} // namespace

class qSlicerFenestraClippingPrivate : public Ui_qSlicerFenestraClipping {
  Q_DECLARE_TR_FUNCTIONS(qSlicerFenestraClipping)

public:
  void listNumbers();
  QString mode(bool isByPreset) const;
  Plane plane() const { return static_cast<Plane>(PlaneBox->currentData().toInt()); }
  void showMode();
  void showPlane(Plane shown);

  QList<Number> numbers;
  QString surfaceText;     ///< name of the default mode
  bool hasFocus = false;   ///< of the flags last shown
  bool isByPreset = false; ///< of the flags last shown
};

void qSlicerFenestraClippingPrivate::listNumbers() {
  constexpr double percent = 0.01, millimeter = 1.0;
  numbers = {{"ghost", ghostBox, percent, {"ghost"}},
             {"holemargin", holemarginBox, millimeter, {"hole"}},
             {"labelsmoothing", labelsmoothingBox, millimeter, anyMode},
             {"offset", offsetBox, millimeter, cuttingModes()},
             {"soft", softBox, millimeter, cuttingModes()},
             {"contextdensity", contextdensityBox, percent, anyMode},
             {"contextsaturation", contextsaturationBox, percent, anyMode}};
}

/// Clip mode, as the renderer names it.
QString qSlicerFenestraClippingPrivate::mode(bool isByPreset) const {
  const QString word = ClipBox->currentData().toString();
  return word.isEmpty() ? (isByPreset ? byPresetMode : "surface") : word;
}

void qSlicerFenestraClippingPrivate::showMode() {
  const QString now = mode(isByPreset);
  const bool surface = now == "surface" || now == "ghost";
  ClipBox->setItemText(0, isByPreset ? tr("From the anatomy preset") : surfaceText);
  showRow(Form, BoundaryBox, surface);
  showRow(Form, HoleBox, now == "hole");
  showRow(Form, PlaneBox, now == "plane");
  showRow(Form, PlaneNodeBox, now == "plane" && plane() == Plane::node);
  for (const Number& number : numbers) {
    if (Form->indexOf(number.box) >= 0)
      showRow(Form, number.box, number.isUsed(now));
    else
      setEnabled(number.box, number.isUsed(now), tr("The clip mode chosen above cuts nothing"));
  }
  setEnabled(ClipDetails, hasFocus, tr("Check a segment under Focus, or choose an anatomy"));
}

qSlicerFenestraClipping::qSlicerFenestraClipping(QWidget* parent)
    : qMRMLWidget(parent), d_ptr(new qSlicerFenestraClippingPrivate) {
  Q_D(qSlicerFenestraClipping);
  d->setupUi(this);
  d->ClipDetails->setCollapsed(true); // after its title is set, which gives the height
  setItemData(d->ClipBox, {"", "ghost", "cutaway", "hole", "plane", "none"});
  setItemData(d->BoundaryBox, {"exact", "spline"});
  setItemData(d->HoleBox, {"", "box", "sphere"});
  d->PlaneBox->setItemData(0, int(Plane::automatic));
  d->PlaneBox->setItemData(1, int(Plane::node));
  d->surfaceText = d->ClipBox->itemText(0);
  d->listNumbers();
  for (QComboBox* box : {d->ClipBox, d->PlaneBox}) // also if no flag changes
    connect(box, QOverload<int>::of(&QComboBox::currentIndexChanged), this, [d] { d->showMode(); });
  for (QComboBox* box : {d->ClipBox, d->BoundaryBox, d->HoleBox, d->PlaneBox})
    connect(box, QOverload<int>::of(&QComboBox::currentIndexChanged), this,
            &qSlicerFenestraClipping::changed);
  for (const Number& number : d->numbers)
    connect(number.box, QOverload<double>::of(&QDoubleSpinBox::valueChanged), this,
            &qSlicerFenestraClipping::changed);
  connect(d->PlaneNodeBox, SIGNAL(currentNodeChanged(vtkMRMLNode*)), this, SIGNAL(changed()));
  connect(d->Margins, &qSlicerFenestraMargins::changed, this, &qSlicerFenestraClipping::changed);
  d->showMode();
}

qSlicerFenestraClipping::~qSlicerFenestraClipping() = default;

vtkMRMLNode* qSlicerFenestraClipping::planeNode() const {
  Q_D(const qSlicerFenestraClipping);
  return d->plane() == Plane::node ? d->PlaneNodeBox->currentNode() : nullptr;
}

// ---- flags

void qSlicerFenestraClipping::show(const Flags& flags, Plane plane,
                                   const QList<qSlicerFenestraSegment>& focus, bool byPreset) {
  Q_D(qSlicerFenestraClipping);
  const QSignalBlocker blocker(this);
  const bool hasFocus = byPreset || !focus.isEmpty();
  setChoiceOffered(d->ClipBox, 1, {d->surfaceText, "surface"}, byPreset);
  const bool clips = hasFocus || flags.count("clip") > 0;
  if (clips)
    selectData(d->ClipBox, findFlag(flags, "clip"));
  const QString now = d->mode(byPreset);
  if (clips && (now == "surface" || now == "ghost")) // the renderer's default, not the panel's
    selectData(d->BoundaryBox, flags.count("boundary") > 0 ? findFlag(flags, "boundary") : "exact");
  if (now == "hole")
    selectData(d->HoleBox, findFlag(flags, "hole"));
  if (now == "plane")
    d->showPlane(plane);
  for (Number& number : d->numbers) {
    if (!hasFocus || !number.isUsed(now))
      continue;
    number.shown = findFlag(flags, number.flag);
    number.box->setValue(number.shown.isEmpty() || number.shown == "auto"
                             ? number.defaultValue
                             : number.shown.toDouble() / number.unit);
    number.shownValue = number.box->value();
  }
  if (hasFocus)
    d->Margins->show(findFlag(flags, "margin"), focus);
  d->hasFocus = hasFocus;
  d->isByPreset = byPreset;
  d->showMode();
}

void qSlicerFenestraClippingPrivate::showPlane(Plane shown) {
  const int fixed = PlaneBox->findData(int(Plane::fixed));
  if (shown == Plane::fixed && fixed < 0)
    PlaneBox->addItem(tr("As rendered"), int(Plane::fixed));
  if (shown != Plane::fixed && fixed >= 0)
    PlaneBox->removeItem(fixed);
  const bool choosing = plane() == Plane::node && !PlaneNodeBox->currentNode();
  if (shown != Plane::automatic || !choosing)
    PlaneBox->setCurrentIndex(PlaneBox->findData(int(shown)));
}

void qSlicerFenestraClipping::reset() {
  Q_D(qSlicerFenestraClipping);
  const QSignalBlocker blocker(this);
  for (QComboBox* box : {d->ClipBox, d->BoundaryBox, d->HoleBox, d->PlaneBox})
    box->setCurrentIndex(0);
  for (Number& number : d->numbers) {
    number.shown.clear();
    number.box->setValue(number.defaultValue);
    number.shownValue = number.defaultValue;
  }
  d->Margins->show({}, {});
}

void qSlicerFenestraClipping::take(Flags& flags, const std::string& plane, bool hasFocus,
                                   bool byPreset) const {
  Q_D(const qSlicerFenestraClipping);
  const QString now = d->mode(byPreset);
  const bool surface = now == "surface" || now == "ghost";
  const std::string fixed = flags["plane"];
  flags["plane"] = now != "plane" || d->plane() == Plane::automatic ? ""
                   : d->plane() == Plane::node                      ? plane
                                                                    : fixed;
  const bool clips = hasFocus || now == "none" || !flags["plane"].empty();
  flags["clip"] = clips ? selectedData(d->ClipBox) : "";
  flags["boundary"] = clips && surface ? selectedData(d->BoundaryBox) : "";
  if (flags["boundary"] != "spline")
    flags["controlpoints"] = flags["smoothing"] = ""; // used only by the spline
  flags["hole"] = clips && now == "hole" ? selectedData(d->HoleBox) : "";
  flags["margin"] = hasFocus ? d->Margins->flag().toStdString() : "";
  for (const Number& number : d->numbers) {
    const double value = number.box->value();
    QString text =
        value == number.defaultValue ? QString() : QString::number(value * number.unit, 'g', 10);
    if (value == number.shownValue)
      text = number.shown;
    flags[number.flag] = hasFocus && number.isUsed(now) ? text.toStdString() : "";
  }
}
