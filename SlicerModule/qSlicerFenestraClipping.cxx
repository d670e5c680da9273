#include "qSlicerFenestraClipping.h"

#include "qSlicerFenestraMargins.h"
#include "qSlicerFenestraWidgets.h"

#include <ctkCollapsibleGroupBox.h>
#include <qMRMLNodeComboBox.h>

#include <QComboBox>
#include <QDoubleSpinBox>
#include <QFormLayout>
#include <QLabel>
#include <QSignalBlocker>
#include <QVBoxLayout>

using namespace qSlicerFenestraWidgets;

namespace {

using Flags = qSlicerFenestraClipping::Flags;

constexpr const char* byPresetMode = "preset"; ///< only the renderer knows the preset's mode
const QStringList& cuttingModes() {
  static const QStringList modes = {"surface", "ghost", "cutaway", "hole", "plane", byPresetMode};
  return modes;
}
const QStringList anyMode; ///< empty list: any mode with a focus

constexpr double automatic = -1.0; ///< value of an AutomaticBox for "auto"

/// Numbers from 0; one step below 0 is "auto", set by Arrow Down or Page Down without a second
/// control. Negative numbers cannot be typed.
class AutomaticBox : public QDoubleSpinBox {
public:
  AutomaticBox() { setSpecialValueText(QObject::tr("auto")); }

  void stepBy(int steps) override {
    const double from = value() < 0.0 ? -singleStep() : value();
    const double to = from + steps * singleStep();
    // A single step down stops at 0 before it reaches "auto".
    setValue(to >= 0.0 ? to : from > 0.0 && steps == -1 ? 0.0 : automatic);
  }

protected:
  QValidator::State validate(QString& text, int& at) const override {
    const bool isNegative = text.contains('-') || text.contains(locale().negativeSign());
    return isNegative ? QValidator::Invalid : QDoubleSpinBox::validate(text, at);
  }
};

} // namespace

qSlicerFenestraClipping::qSlicerFenestraClipping(qMRMLNodeComboBox* planeNode, QWidget* parent)
    : QWidget(parent), m_planeNode(planeNode) {
  m_form = new QFormLayout(this);
  m_form->setContentsMargins(0, 0, 0, 0);
  buildMode(m_form);
  auto* details = new ctkCollapsibleGroupBox(tr("Margins, edge and surroundings"));
  details->setObjectName("ClipDetails");
  details->setCollapsed(true);
  m_details = details;
  buildDetails(new QFormLayout(details));
  m_form->addRow(details);
  for (QComboBox* box : {m_clip, m_plane}) // also if no flag changes
    connect(box, QOverload<int>::of(&QComboBox::currentIndexChanged), this,
            &qSlicerFenestraClipping::showMode);
  for (QComboBox* box : {m_clip, m_boundary, m_holeShape, m_plane})
    connect(box, QOverload<int>::of(&QComboBox::currentIndexChanged), this,
            &qSlicerFenestraClipping::changed);
  connect(m_planeNode, SIGNAL(currentNodeChanged(vtkMRMLNode*)), this, SIGNAL(changed()));
  connect(m_margins, &qSlicerFenestraMargins::changed, this, &qSlicerFenestraClipping::changed);
  showMode();
}

void qSlicerFenestraClipping::buildMode(QFormLayout* form) {
  m_clip = makeComboBox("ClipBox",
                        {{tr("Smooth surface through the focus"), ""},
                         {tr("Surface, with faint tissue in front"), "ghost"},
                         {tr("Everything in front of the focus (cutaway)"), "cutaway"},
                         {tr("Hole toward the focus"), "hole"},
                         {tr("Plane"), "plane"},
                         {tr("Nothing"), "none"}},
                        tr("Tissue to remove so that the focus is visible"));
  form->addRow(tr("Clip:"), m_clip);
  m_boundary =
      makeComboBox("BoundaryBox", {{tr("Exact"), "exact"}, {tr("Smoothed (spline)"), "spline"}},
                   tr("How the surface continues beside the focus. Exact: from its edge, "
                      "without a step or kink. Smoothed: close to its edge, as in the paper"));
  form->addRow(tr("Edge of the focus:"), m_boundary);
  addNumber(form, "ghost", tr("Density in front:"), 0.01, 10.0, {"ghost"},
            tr("Percentage of its density that tissue in front of the surface keeps"));
  m_holeShape =
      makeComboBox("HoleBox", {{tr("Cylinder"), ""}, {tr("Box"), "box"}, {tr("Sphere"), "sphere"}},
                   tr("Shape of the hole from the camera to the focus"));
  form->addRow(tr("Shape:"), m_holeShape);
  addNumber(form, "holemargin", tr("Wider by:"), 1.0, 5.0, {"hole"},
            tr("How much wider the hole is than the focus"));
  m_plane = makeComboBox("PlaneBox", {}, tr("Position of the clip plane"));
  m_plane->addItem(tr("Automatic, at the focus"), int(Plane::automatic));
  m_plane->addItem(tr("Plane of the scene"), int(Plane::node));
  form->addRow(tr("Plane:"), m_plane);
  m_planeNode->setNoneEnabled(true);
  m_planeNode->setToolTip(tr("Create a plane in the Markups module. The side that its normal "
                             "points to is removed; the preview follows the plane as you move it"));
  form->addRow(tr("Plane node:"), m_planeNode);
}

void qSlicerFenestraClipping::buildDetails(QFormLayout* form) {
  m_margins = new qSlicerFenestraMargins;
  form->addRow(tr("Margin:"), m_margins);
  addNumber(form, "labelsmoothing", tr("Smooth labels by:"), 1.0, automatic, anyMode,
            tr("Removes the stair steps of the segments' voxels. auto (below 0): chosen by voxel "
               "size, or by the anatomy preset"));
  addNumber(form, "offset", tr("Move the cut by:"), 1.0, 0.0, cuttingModes(),
            tr("Away from the camera, into the focus; negative: toward the camera"));
  addNumber(form, "soft", tr("Soft edge:"), 1.0, automatic, cuttingModes(),
            tr("Depth behind the cut over which tissue fades in. auto (below 0): chosen by voxel "
               "size, or by the anatomy preset"));
  addNumber(form, "contextdensity", tr("Surroundings, density:"), 0.01, 100.0, anyMode,
            tr("Makes everything but the focus more transparent"));
  addNumber(form, "contextsaturation", tr("Surroundings, color:"), 0.01, automatic, anyMode,
            tr("0 %: everything but the focus is gray. auto (below 0): reduced only where the "
               "focus looks like its surroundings, or chosen by the anatomy preset"));
}

void qSlicerFenestraClipping::addNumber(QFormLayout* form, const char* flag, const QString& label,
                                        double unit, double defaultValue, const QStringList& modes,
                                        const QString& help) {
  const bool isPercent = unit != 1.0;
  const bool isSigned = flag == std::string("offset");
  const bool mayBeAutomatic = defaultValue == automatic;
  const double maximum = isPercent || flag == std::string("labelsmoothing") ? 100.0 : 1000.0;
  auto* box = mayBeAutomatic ? new AutomaticBox : new QDoubleSpinBox;
  box->setObjectName(QString(flag) + "Box");
  box->setRange(mayBeAutomatic ? automatic : isSigned ? -maximum : 0.0, maximum);
  box->setDecimals(isPercent ? 1 : 2);
  box->setSingleStep(isPercent ? 5.0 : 0.5);
  box->setSuffix(isPercent ? tr(" %") : tr(" mm"));
  box->setToolTip(help);
  box->setValue(defaultValue);
  form->addRow(label, box);
  connect(box, QOverload<double>::of(&QDoubleSpinBox::valueChanged), this,
          &qSlicerFenestraClipping::changed);
  m_numbers.append({flag, box, unit, defaultValue, modes, {}, defaultValue});
}

qSlicerFenestraClipping::Plane qSlicerFenestraClipping::plane() const {
  return static_cast<Plane>(m_plane->currentData().toInt());
}

/// Clip mode, as the renderer names it.
QString qSlicerFenestraClipping::mode(bool byPreset) const {
  const QString word = m_clip->currentData().toString();
  return word.isEmpty() ? (byPreset ? byPresetMode : "surface") : word;
}

void qSlicerFenestraClipping::showMode() {
  const QString now = mode(m_byPreset);
  const bool surface = now == "surface" || now == "ghost";
  m_clip->setItemText(0, m_byPreset ? tr("From the anatomy preset")
                                    : tr("Smooth surface through the focus"));
  showRow(m_form, m_boundary, surface);
  showRow(m_form, m_holeShape, now == "hole");
  showRow(m_form, m_plane, now == "plane");
  showRow(m_form, m_planeNode, now == "plane" && plane() == Plane::node);
  for (const Number& number : m_numbers) {
    if (m_form->indexOf(number.box) >= 0)
      showRow(m_form, number.box, number.modes.contains(now));
    else
      number.box->setEnabled(number.modes.isEmpty() || number.modes.contains(now));
  }
  m_details->setEnabled(m_hasFocus);
}

// ---- flags

void qSlicerFenestraClipping::show(const Flags& flags, Plane plane,
                                   const QList<qSlicerFenestraSegment>& focus, bool byPreset) {
  const QSignalBlocker blocker(this);
  const bool hasFocus = byPreset || !focus.isEmpty();
  const int surface = m_clip->findData("surface");
  if (byPreset && surface < 0)
    m_clip->insertItem(1, tr("Smooth surface through the focus"), "surface");
  if (!byPreset && surface >= 0)
    m_clip->removeItem(surface);
  const bool clips = hasFocus || flags.count("clip") > 0;
  if (clips)
    selectData(m_clip, findFlag(flags, "clip"));
  const QString now = mode(byPreset);
  if (clips && (now == "surface" || now == "ghost")) // the renderer's default, not the panel's
    selectData(m_boundary, flags.count("boundary") > 0 ? findFlag(flags, "boundary") : "spline");
  if (now == "hole")
    selectData(m_holeShape, findFlag(flags, "hole"));
  if (now == "plane") {
    const int fixed = m_plane->findData(int(Plane::fixed));
    if (plane == Plane::fixed && fixed < 0)
      m_plane->addItem(tr("As rendered"), int(Plane::fixed));
    if (plane != Plane::fixed && fixed >= 0)
      m_plane->removeItem(fixed);
    const bool choosing = this->plane() == Plane::node && !m_planeNode->currentNode();
    if (plane != Plane::automatic || !choosing)
      m_plane->setCurrentIndex(m_plane->findData(int(plane)));
  }
  for (Number& number : m_numbers) {
    if (!hasFocus || !(number.modes.isEmpty() || number.modes.contains(now)))
      continue;
    number.shown = findFlag(flags, number.flag);
    number.box->setValue(number.shown.isEmpty() || number.shown == "auto"
                             ? number.defaultValue
                             : number.shown.toDouble() / number.unit);
    number.shownValue = number.box->value();
  }
  if (hasFocus)
    m_margins->show(findFlag(flags, "margin"), focus);
  m_hasFocus = hasFocus;
  m_byPreset = byPreset;
  showMode();
}

void qSlicerFenestraClipping::reset() {
  const QSignalBlocker blocker(this);
  for (QComboBox* box : {m_clip, m_boundary, m_holeShape, m_plane})
    box->setCurrentIndex(0);
  for (Number& number : m_numbers) {
    number.shown.clear();
    number.box->setValue(number.defaultValue);
    number.shownValue = number.defaultValue;
  }
  m_margins->show({}, {});
}

void qSlicerFenestraClipping::take(Flags& flags, const std::string& plane, bool hasFocus,
                                   bool byPreset) const {
  const QString now = mode(byPreset);
  const auto word = [](const QComboBox* box) {
    return box->currentData().toString().toStdString();
  };
  const bool surface = now == "surface" || now == "ghost";
  const std::string fixed = flags["plane"];
  flags["plane"] = now != "plane" || this->plane() == Plane::automatic ? ""
                   : this->plane() == Plane::node                      ? plane
                                                                       : fixed;
  const bool clips = hasFocus || now == "none" || !flags["plane"].empty();
  flags["clip"] = clips ? word(m_clip) : "";
  flags["boundary"] = clips && surface ? word(m_boundary) : "";
  if (flags["boundary"] != "spline")
    flags["controlpoints"] = flags["smoothing"] = ""; // used only by the spline
  flags["hole"] = clips && now == "hole" ? word(m_holeShape) : "";
  flags["margin"] = hasFocus ? m_margins->flag().toStdString() : "";
  for (const Number& number : m_numbers) {
    const bool isUsed = hasFocus && (number.modes.isEmpty() || number.modes.contains(now));
    const double value = number.box->value();
    QString text =
        value == number.defaultValue ? QString() : QString::number(value * number.unit, 'g', 10);
    if (value == number.shownValue)
      text = number.shown;
    flags[number.flag] = isUsed ? text.toStdString() : "";
  }
}
