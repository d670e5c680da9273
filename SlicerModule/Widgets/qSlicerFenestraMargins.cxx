#include "qSlicerFenestraMargins.h"

#include "qSlicerFenestraWidgets.h"
#include "ui_qSlicerFenestraMargins.h"

#include <QLabel>
#include <QMap>
#include <QSignalBlocker>

class qSlicerFenestraMarginsPrivate : public Ui_qSlicerFenestraMargins {
  Q_DECLARE_TR_FUNCTIONS(qSlicerFenestraMargins)

public:
  bool isAutomatic() const { return MarginAutoBox->isChecked(); }
  bool isOnePerSegment() const {
    return !isAutomatic() && MarginEachBox->isChecked() && boxes.size() > 1;
  }
  void showEach();

  QList<qSlicerFenestraSegment> focus;
  QList<QDoubleSpinBox*> boxes;  ///< one per focus segment
  QMap<QString, double> margins; ///< mm by segment id; kept for segments outside the focus
};

void qSlicerFenestraMarginsPrivate::showEach() {
  MarginEachBox->setVisible(boxes.size() > 1);
  const QString chosen = tr("The margin is automatic");
  qSlicerFenestraWidgets::setEnabled(MarginEachBox, !isAutomatic(), chosen);
  qSlicerFenestraWidgets::setEnabled(MarginBox, !isAutomatic() && !isOnePerSegment(),
                                     isAutomatic() ? chosen
                                                   : tr("Each segment has its own margin below"));
  for (QDoubleSpinBox* box : boxes)
    qSlicerFenestraWidgets::showRow(Rows, box, isOnePerSegment());
}

qSlicerFenestraMargins::qSlicerFenestraMargins(QWidget* parent)
    : QWidget(parent), d_ptr(new qSlicerFenestraMarginsPrivate) {
  Q_D(qSlicerFenestraMargins);
  d->setupUi(this);
  connect(d->MarginBox, QOverload<double>::of(&QDoubleSpinBox::valueChanged), this,
          &qSlicerFenestraMargins::changed);
  connect(d->MarginAutoBox, &QCheckBox::toggled, this, [this, d] {
    d->showEach();
    emit changed();
  });
  connect(d->MarginEachBox, &QCheckBox::toggled, this, [this, d](bool each) {
    if (each)
      for (QDoubleSpinBox* box : d->boxes)
        box->setValue(d->MarginBox->value());
    d->showEach();
    emit changed();
  });
  d->showEach();
}

qSlicerFenestraMargins::~qSlicerFenestraMargins() = default;

void qSlicerFenestraMargins::show(const QString& flag, const QList<qSlicerFenestraSegment>& focus) {
  Q_D(qSlicerFenestraMargins);
  const QSignalBlocker blocker(this);
  const QStringList numbers = flag.split(',');
  build(focus);
  const bool each = numbers.size() > 1 && numbers.size() == focus.size();
  {
    const QSignalBlocker autoBlocker(d->MarginAutoBox),
        eachBlocker(d->MarginEachBox); // the numbers are set below
    d->MarginAutoBox->setChecked(flag.isEmpty() || flag == "auto");
    d->MarginEachBox->setChecked(each);
  }
  if (!each)
    d->MarginBox->setValue(numbers.first().toDouble());
  for (int i = 0; each && i < d->boxes.size(); ++i)
    d->boxes[i]->setValue(numbers[i].toDouble());
  d->showEach();
}

QString qSlicerFenestraMargins::flag() const {
  Q_D(const qSlicerFenestraMargins);
  if (d->isAutomatic())
    return {};
  QStringList numbers;
  if (d->isOnePerSegment())
    for (const QDoubleSpinBox* box : d->boxes)
      numbers << QString::number(box->value());
  else
    numbers << QString::number(d->MarginBox->value());
  return numbers.join(',');
}

void qSlicerFenestraMargins::build(const QList<qSlicerFenestraSegment>& focus) {
  Q_D(qSlicerFenestraMargins);
  if (focus == d->focus)
    return;
  d->focus = focus;
  d->boxes.clear();
  while (d->Rows->rowCount() > 0)
    d->Rows->removeRow(0);
  for (const qSlicerFenestraSegment& segment : focus) {
    auto* box = new QDoubleSpinBox;
    box->setObjectName(QString("Margin%1").arg(d->boxes.size()));
    box->setRange(d->MarginBox->minimum(), d->MarginBox->maximum());
    box->setSingleStep(d->MarginBox->singleStep());
    box->setSuffix(d->MarginBox->suffix());
    box->setValue(d->margins.value(segment.id, d->MarginBox->value()));
    connect(box, QOverload<double>::of(&QDoubleSpinBox::valueChanged), this,
            [this, d, id = segment.id](double margin) {
              d->margins[id] = margin;
              emit changed();
            });
    auto* name = new QLabel(segment.name + ":");
    name->setWordWrap(true);
    name->setBuddy(box);
    d->Rows->addRow(name, box);
    d->boxes << box;
  }
}
