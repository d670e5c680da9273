#include "qSlicerFenestraQuality.h"

#include "qSlicerFenestraWidgets.h"
#include "ui_qSlicerFenestraQuality.h"

#include <QSignalBlocker>
#include <QSize>

using namespace qSlicerFenestraWidgets;

namespace {

QString toText(const QSize& size) {
  return QString("%1x%2").arg(size.width()).arg(size.height());
}

/// Empty: the text is no size.
QSize toSize(const QString& text) {
  return {text.section('x', 0, 0).toInt(), text.section('x', 1, 1).toInt()};
}

QString toViewSize(int factor, const QString& size) {
  return QString("%1 %2").arg(factor).arg(size);
}

/// Pixels of an image "as the 3D view" per pixel of the view, along each edge; 0: the size is
/// fixed.
int findFactor(const qSlicerFenestraQuality::Flags& flags, const QString& viewSize) {
  const int factor = viewSize.section(' ', 0, 0).toInt();
  return viewSize == toViewSize(factor, findFlag(flags, "size")) ? qBound(0, factor, 4) : 0;
}

} // namespace

class qSlicerFenestraQualityPrivate : public Ui_qSlicerFenestraQuality {
public:
  QString sizeText() const { return toText({WidthBox->value(), HeightBox->value()}); }
  void showSize(const QSize& size);
};

void qSlicerFenestraQualityPrivate::showSize(const QSize& size) {
  const QSignalBlocker blockers[] = {QSignalBlocker(WidthBox), QSignalBlocker(HeightBox)};
  WidthBox->setValue(size.width());
  HeightBox->setValue(size.height());
}

qSlicerFenestraQuality::qSlicerFenestraQuality(QWidget* parent)
    : QWidget(parent), d_ptr(new qSlicerFenestraQualityPrivate) {
  Q_D(qSlicerFenestraQuality);
  d->setupUi(this);
  setItemData(d->QualityBox, {"16 0 0", "256 0.05 0", "4096 0.015 0", ""}); // samples noise seconds
  setItemData(d->SizeBox, {"1", "2", "4", "512x512", "1024x1024", "2048x2048", "1280x720",
                           "1920x1080", "3840x2160", ""});
  connect(d->QualityBox, QOverload<int>::of(&QComboBox::currentIndexChanged), this,
          &qSlicerFenestraQuality::takeLimits);
  connect(d->SizeBox, QOverload<int>::of(&QComboBox::currentIndexChanged), this,
          &qSlicerFenestraQuality::takeSize);
  for (QComboBox* box : {d->QualityBox, d->SizeBox})
    connect(box, QOverload<int>::of(&QComboBox::activated), this, [d, box] {
      if (box->currentData().toString().isEmpty()) // custom: the numbers are in this section
        d->Quality->setCollapsed(false);
    });
  for (QSpinBox* box : {d->WidthBox, d->HeightBox})
    connect(box, QOverload<int>::of(&QSpinBox::valueChanged), this,
            &qSlicerFenestraQuality::onSizeTyped);
  connect(d->SamplesBox, QOverload<int>::of(&QSpinBox::valueChanged), this,
          &qSlicerFenestraQuality::changed);
  for (QDoubleSpinBox* box : {d->NoiseBox, d->SecondsBox})
    connect(box, QOverload<double>::of(&QDoubleSpinBox::valueChanged), this,
            &qSlicerFenestraQuality::changed);
}

qSlicerFenestraQuality::~qSlicerFenestraQuality() = default;

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

/// Takes the chosen size, if it is fixed.
void qSlicerFenestraQuality::takeSize() {
  Q_D(qSlicerFenestraQuality);
  if (const QSize size = toSize(d->SizeBox->currentData().toString()); !size.isEmpty())
    d->showSize(size);
  emit changed();
}

void qSlicerFenestraQuality::onSizeTyped() {
  Q_D(qSlicerFenestraQuality);
  const QSignalBlocker blocker(d->SizeBox);
  const int index = d->SizeBox->findData(d->sizeText());
  d->SizeBox->setCurrentIndex(index < 0 ? d->SizeBox->count() - 1 : index);
  emit changed();
}

void qSlicerFenestraQuality::show(const Flags& flags, const QString& viewSize) {
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
  const QString size = findFlag(flags, "size");
  d->showSize(size.isEmpty() ? QSize(512, 512) : toSize(size)); // the renderer's default
  onSizeTyped();
  const QSignalBlocker sizeBlocker(d->SizeBox);
  if (const int factor = findFactor(flags, viewSize); factor > 0)
    selectData(d->SizeBox, QString::number(factor));
}

QString qSlicerFenestraQuality::take(Flags& flags) const {
  Q_D(const qSlicerFenestraQuality);
  flags["samples"] = std::to_string(d->SamplesBox->value());
  flags["noise"] = toLimitFlag(d->NoiseBox->value());
  flags["seconds"] = toLimitFlag(d->SecondsBox->value());
  flags["size"] = d->sizeText().toStdString();
  const int factor = d->SizeBox->currentData().toInt(); // 0 for "512x512"
  return factor > 0 ? toViewSize(factor, d->sizeText()) : QString();
}

QString qSlicerFenestraQuality::followView(Flags& flags, const QString& viewSize,
                                           const QSize& pixels) const {
  Q_D(const qSlicerFenestraQuality);
  const int factor = findFactor(flags, viewSize);
  QSize size = factor * pixels;
  if (size.isEmpty())
    return viewSize;
  const QSize limit(d->WidthBox->maximum(), d->HeightBox->maximum());
  if (size.boundedTo(limit) != size)
    size.scale(limit, Qt::KeepAspectRatio);
  flags["size"] = toText(size).toStdString();
  return toViewSize(factor, toText(size));
}
