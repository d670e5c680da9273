#include "qSlicerFenestraQuality.h"

#include "qSlicerFenestraWidgets.h"
#include "ui_qSlicerFenestraQuality.h"

#include <QSignalBlocker>

using namespace qSlicerFenestraWidgets;

namespace {

/// Flag value of a limit; empty (not passed): no limit.
std::string toLimitFlag(double value) {
  return value > 0.0 ? QString::number(value, 'g', 6).toStdString() : std::string();
}

} // namespace

class qSlicerFenestraQualityPrivate : public Ui_qSlicerFenestraQuality {};

qSlicerFenestraQuality::qSlicerFenestraQuality(QWidget* parent)
    : QWidget(parent), d_ptr(new qSlicerFenestraQualityPrivate) {
  Q_D(qSlicerFenestraQuality);
  d->setupUi(this);
  setItemData(d->QualityBox, {"16 0 0", "256 0.05 0", "4096 0.015 0", ""}); // samples noise seconds
  connect(d->QualityBox, QOverload<int>::of(&QComboBox::currentIndexChanged), this,
          &qSlicerFenestraQuality::takeLimits);
  for (QSpinBox* box : {d->SamplesBox, d->WidthBox, d->HeightBox, d->FramesBox})
    connect(box, QOverload<int>::of(&QSpinBox::valueChanged), this,
            &qSlicerFenestraQuality::changed);
  for (QDoubleSpinBox* box : {d->NoiseBox, d->SecondsBox, d->DegreesBox, d->SteadyBox})
    connect(box, QOverload<double>::of(&QDoubleSpinBox::valueChanged), this,
            &qSlicerFenestraQuality::changed);
  connect(d->TurnButton, &QPushButton::clicked, this, &qSlicerFenestraQuality::turntableRequested);
}

qSlicerFenestraQuality::~qSlicerFenestraQuality() = default;

void qSlicerFenestraQuality::setHasVolume(bool has) {
  Q_D(qSlicerFenestraQuality);
  qSlicerFenestraWidgets::setEnabled(d->TurnButton, has, tr("Choose a volume first"));
}

/// Takes the limits of the chosen quality.
void qSlicerFenestraQuality::takeLimits() {
  Q_D(qSlicerFenestraQuality);
  const QStringList numbers = d->QualityBox->currentData().toString().split(' ');
  if (numbers.size() != 3)
    return;
  {
    const QSignalBlocker blocker(this);
    d->SamplesBox->setValue(numbers[0].toInt());
    d->NoiseBox->setValue(numbers[1].toDouble());
    d->SecondsBox->setValue(numbers[2].toDouble());
  }
  emit changed();
}

void qSlicerFenestraQuality::show(const Flags& flags) {
  Q_D(qSlicerFenestraQuality);
  const QSignalBlocker blocker(this);
  const int samples = findFlag(flags, "samples").toInt();
  const double noise = findFlag(flags, "noise").toDouble();
  const double seconds = findFlag(flags, "seconds").toDouble();
  const int index =
      d->QualityBox->findData(QString("%1 %2 %3").arg(samples).arg(noise).arg(seconds));
  d->QualityBox->setCurrentIndex(index < 0 ? d->QualityBox->count() - 1 : index);
  d->SamplesBox->setValue(samples);
  d->NoiseBox->setValue(noise);
  d->SecondsBox->setValue(seconds);
  const QStringList size = findFlag(flags, "size").split('x');
  d->WidthBox->setValue(size.value(0, "512").toInt());
  d->HeightBox->setValue(size.value(1, "512").toInt());
  if (flags.count("frames") == 0) // flags of a repeated image, not of a turntable
    return;
  d->FramesBox->setValue(findFlag(flags, "frames").toInt());
  d->DegreesBox->setValue(flags.count("degrees") > 0 ? findFlag(flags, "degrees").toDouble()
                                                     : 360.0);
  d->SteadyBox->setValue(findFlag(flags, "steady").toDouble());
}

void qSlicerFenestraQuality::take(Flags& flags) const {
  Q_D(const qSlicerFenestraQuality);
  flags["samples"] = std::to_string(d->SamplesBox->value());
  flags["noise"] = toLimitFlag(d->NoiseBox->value());
  flags["seconds"] = toLimitFlag(d->SecondsBox->value());
  flags["size"] =
      std::to_string(d->WidthBox->value()) + "x" + std::to_string(d->HeightBox->value());
  flags["frames"] = std::to_string(d->FramesBox->value());
  flags["degrees"] = QString::number(d->DegreesBox->value()).toStdString();
  flags["steady"] = toLimitFlag(d->SteadyBox->value());
}
