#include "qSlicerFenestraMargins.h"

#include <QCheckBox>
#include <QDoubleSpinBox>
#include <QFormLayout>
#include <QLabel>
#include <QSignalBlocker>
#include <QVBoxLayout>

#include <algorithm>

namespace {

QDoubleSpinBox* makeMillimeterBox(const QString& name) {
  constexpr double maximum = 1000.0; // the renderer's limit
  auto* box = new QDoubleSpinBox;
  box->setObjectName(name);
  box->setRange(-maximum, maximum);
  box->setSingleStep(0.5);
  box->setSuffix(QObject::tr(" mm"));
  box->setToolTip(QObject::tr("Grows the segment for clipping; negative: shrinks it"));
  return box;
}

bool areEqual(const QList<qSlicerFenestraSegment>& a, const QList<qSlicerFenestraSegment>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const qSlicerFenestraSegment& one, const qSlicerFenestraSegment& other) {
                      return one.id == other.id && one.name == other.name;
                    });
}

} // namespace

qSlicerFenestraMargins::qSlicerFenestraMargins(QWidget* parent) : QWidget(parent) {
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  m_all = makeMillimeterBox("MarginBox");
  layout->addWidget(m_all);
  m_each = new QCheckBox(tr("one per segment"));
  m_each->setObjectName("MarginEachBox");
  layout->addWidget(m_each);
  m_rows = new QFormLayout;
  layout->addLayout(m_rows);
  connect(m_all, QOverload<double>::of(&QDoubleSpinBox::valueChanged), this,
          &qSlicerFenestraMargins::changed);
  connect(m_each, &QCheckBox::toggled, this, [this](bool each) {
    if (each)
      for (QDoubleSpinBox* box : m_boxes)
        box->setValue(m_all->value());
    showEach();
    emit changed();
  });
  showEach();
}

void qSlicerFenestraMargins::show(const QString& flag, const QList<qSlicerFenestraSegment>& focus) {
  const QSignalBlocker blocker(this);
  const QStringList numbers = flag.split(',');
  build(focus);
  const bool each = numbers.size() > 1 && numbers.size() == focus.size();
  {
    const QSignalBlocker eachBlocker(m_each); // the numbers are set below
    m_each->setChecked(each);
  }
  if (!each)
    m_all->setValue(numbers.first().toDouble());
  for (int i = 0; each && i < m_boxes.size(); ++i)
    m_boxes[i]->setValue(numbers[i].toDouble());
  showEach();
}

QString qSlicerFenestraMargins::flag() const {
  QStringList numbers;
  if (m_each->isChecked() && m_boxes.size() > 1)
    for (const QDoubleSpinBox* box : m_boxes)
      numbers << QString::number(box->value());
  else
    numbers << QString::number(m_all->value());
  const bool none = std::all_of(numbers.begin(), numbers.end(),
                                [](const QString& number) { return number.toDouble() == 0.0; });
  return none && !m_each->isChecked() ? QString() : numbers.join(',');
}

void qSlicerFenestraMargins::build(const QList<qSlicerFenestraSegment>& focus) {
  if (areEqual(focus, m_focus))
    return;
  m_focus = focus;
  m_boxes.clear();
  while (m_rows->rowCount() > 0)
    m_rows->removeRow(0);
  for (int i = 0; i < focus.size(); ++i) {
    const QString id = focus[i].id;
    QDoubleSpinBox* box = makeMillimeterBox(QString("Margin%1").arg(i));
    box->setValue(m_margins.value(id, m_all->value()));
    connect(box, QOverload<double>::of(&QDoubleSpinBox::valueChanged), this,
            [this, id](double margin) {
              m_margins[id] = margin;
              emit changed();
            });
    auto* name = new QLabel(focus[i].name + ":");
    name->setWordWrap(true);
    m_rows->addRow(name, box);
    m_boxes << box;
  }
}

void qSlicerFenestraMargins::showEach() {
  m_each->setVisible(m_boxes.size() > 1);
  const bool each = m_each->isChecked() && m_boxes.size() > 1;
  m_all->setEnabled(!each);
  for (QDoubleSpinBox* box : m_boxes) {
    box->setVisible(each);
    m_rows->labelForField(box)->setVisible(each);
  }
}
