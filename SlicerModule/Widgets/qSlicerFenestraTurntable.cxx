#include "qSlicerFenestraTurntable.h"

#include "qSlicerFenestraWidgets.h"
#include "ui_qSlicerFenestraTurntable.h"

#include <QSignalBlocker>

using namespace qSlicerFenestraWidgets;

class qSlicerFenestraTurntablePrivate : public Ui_qSlicerFenestraTurntable {};

qSlicerFenestraTurntable::qSlicerFenestraTurntable(QWidget* parent)
    : QWidget(parent), d_ptr(new qSlicerFenestraTurntablePrivate) {
  Q_D(qSlicerFenestraTurntable);
  d->setupUi(this);
  connect(d->FramesBox, QOverload<int>::of(&QSpinBox::valueChanged), this,
          &qSlicerFenestraTurntable::changed);
  for (QDoubleSpinBox* box : {d->DegreesBox, d->SteadyBox})
    connect(box, QOverload<double>::of(&QDoubleSpinBox::valueChanged), this,
            &qSlicerFenestraTurntable::changed);
  connect(d->TurnButton, &QPushButton::clicked, this,
          &qSlicerFenestraTurntable::turntableRequested);
}

qSlicerFenestraTurntable::~qSlicerFenestraTurntable() = default;

void qSlicerFenestraTurntable::setHasVolume(bool has) {
  Q_D(qSlicerFenestraTurntable);
  qSlicerFenestraWidgets::setEnabled(d->TurnButton, has, tr("Choose a volume first"));
}

void qSlicerFenestraTurntable::show(const Flags& flags) {
  Q_D(qSlicerFenestraTurntable);
  if (flags.count("frames") == 0) // flags of a repeated image, not of a turntable
    return;
  const QSignalBlocker blocker(this);
  d->FramesBox->setValue(findFlag(flags, "frames").toInt());
  d->DegreesBox->setValue(flags.count("degrees") > 0 ? findFlag(flags, "degrees").toDouble()
                                                     : 360.0);
  d->SteadyBox->setValue(findFlag(flags, "steady").toDouble());
}

void qSlicerFenestraTurntable::take(Flags& flags) const {
  Q_D(const qSlicerFenestraTurntable);
  flags["frames"] = std::to_string(d->FramesBox->value());
  flags["degrees"] = QString::number(d->DegreesBox->value()).toStdString();
  flags["steady"] = toLimitFlag(d->SteadyBox->value());
}
