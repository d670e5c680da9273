#include "qSlicerFenestraLook.h"

#include "qSlicerFenestraLights.h"
#include "qSlicerFenestraWidgets.h"
#include "ui_qSlicerFenestraLook.h"

#include <QSignalBlocker>
#include <QStringList>

#include <array>

using namespace qSlicerFenestraWidgets;

namespace {

constexpr const char* defaultTone = "film"; ///< the renderer's default

} // namespace

class qSlicerFenestraLookPrivate : public Ui_qSlicerFenestraLook {
  Q_DECLARE_TR_FUNCTIONS(qSlicerFenestraLook)

public:
  /// Percent; key, fill, rim, environment.
  std::array<ctkSliderWidget*, 4> strengths() const {
    return {Strength0, Strength1, Strength2, Strength3};
  }
  void showLights(const QString& lights, const QString& rig);

  double shownExposure = 0.0; ///< a flag outside the box's range stays until the box changes
  QString shownTone = defaultTone;
  QString defaultTransfer, defaultRig; ///< texts of the items for "no flag"
};

qSlicerFenestraLook::qSlicerFenestraLook(QWidget* parent)
    : QWidget(parent), d_ptr(new qSlicerFenestraLookPrivate) {
  Q_D(qSlicerFenestraLook);
  d->setupUi(this);
  setItemData(d->TransferBox,
              {"", "ct-anatomy", "ct-contrast", "ct-lung", "ct-bone", "ct-skin", "ct-soft",
               "ct-skeleton", "mr-anatomy", "mr-knee", "us-fetal", "pet"});
  setItemIcons(d->TransferBox, "transfer");
  setItemData(d->RigBox,
              {"", "theatre-wet", "theatre", "cinema", "studio", "headlight", "soft", "amber"});
  setItemIcons(d->RigBox, "lights");
  setItemData(d->BackgroundBox, {"dark", "gradient", "gray", "100,100,100", "transparent"});
  setItemData(d->ToneBox, {defaultTone, "photographic"});
  d->defaultTransfer = d->TransferBox->itemText(0);
  d->defaultRig = d->RigBox->itemText(0);
  for (QComboBox* box : {d->TransferBox, d->RigBox, d->BackgroundBox, d->ToneBox})
    connect(box, QOverload<int>::of(&QComboBox::currentIndexChanged), this,
            &qSlicerFenestraLook::changed);
  for (ctkSliderWidget* slider : d->strengths())
    connect(slider, &ctkSliderWidget::valueChanged, this, &qSlicerFenestraLook::changed);
  connect(d->ExposureBox, QOverload<double>::of(&QDoubleSpinBox::valueChanged), this,
          &qSlicerFenestraLook::changed);
}

qSlicerFenestraLook::~qSlicerFenestraLook() = default;

// ---- flags

void qSlicerFenestraLook::show(const Flags& flags, const QString& rig, bool byPreset) {
  Q_D(qSlicerFenestraLook);
  const QSignalBlocker blocker(this);
  const QString fromPreset = tr("From the anatomy preset");
  d->TransferBox->setItemText(0, byPreset ? fromPreset : d->defaultTransfer);
  d->RigBox->setItemText(0, byPreset ? fromPreset : d->defaultRig);
  selectOrAdd(d->TransferBox, findFlag(flags, "transfer"));
  selectOrAdd(d->BackgroundBox, findFlag(flags, "background"));
  d->showLights(findFlag(flags, "lights"), rig);
  d->ExposureBox->setValue(findFlag(flags, "exposure").toDouble());
  d->shownExposure = d->ExposureBox->value();
  selectData(d->ToneBox, findFlag(flags, "tone"));
  d->shownTone = d->ToneBox->currentData().toString();
}

void qSlicerFenestraLookPrivate::showLights(const QString& lights, const QString& rig) {
  const QStringList parts = rig.split(' ');
  qSlicerFenestraLights::Strengths strengths = qSlicerFenestraLights::unchanged;
  for (std::size_t i = 0; i < strengths.size(); ++i) {
    bool isNumber = false;
    const double percent = parts.value(static_cast<int>(i) + 1).toDouble(&isNumber);
    if (isNumber && percent >= 0.0 && percent <= Strength0->maximum())
      strengths[i] = percent / 100.0;
  }
  const bool isConsistent = RigBox->findData(parts[0]) >= 0 &&
                            qSlicerFenestraLights::makeFlag(parts[0], strengths) == lights;
  selectOrAdd(RigBox, isConsistent ? parts[0] : lights);
  if (!isConsistent)
    strengths = qSlicerFenestraLights::unchanged;
  const QString chosen = RigBox->currentData().toString();
  const auto has = qSlicerFenestraLights::findLights(chosen);
  const QString reason = chosen.isEmpty() ? tr("Choose a rig above to change its lights")
                                          : tr("The rig chosen above has no such light");
  for (std::size_t i = 0; i < strengths.size(); ++i) {
    this->strengths()[i]->setValue(100.0 * strengths[i]);
    setEnabled(this->strengths()[i], has[i], reason);
  }
  showRow(Form, LightsHint, chosen.isEmpty());
}

void qSlicerFenestraLook::resetToPreset() {
  Q_D(qSlicerFenestraLook);
  const QSignalBlocker blocker(this);
  for (QComboBox* box : {d->TransferBox, d->RigBox})
    selectData(box, "");
}

QString qSlicerFenestraLook::take(Flags& flags) const {
  Q_D(const qSlicerFenestraLook);
  flags["transfer"] = selectedData(d->TransferBox);
  flags["background"] = selectedData(d->BackgroundBox);
  const QString rig = d->RigBox->currentData().toString();
  QString stored = rig;
  qSlicerFenestraLights::Strengths strengths{};
  for (std::size_t i = 0; i < strengths.size(); ++i) {
    const double percent = d->strengths()[i]->value();
    strengths[i] = percent / 100.0;
    stored += QString(" %1").arg(percent);
  }
  flags["lights"] = qSlicerFenestraLights::makeFlag(rig, strengths).toStdString();
  if (const double exposure = d->ExposureBox->value(); exposure != d->shownExposure)
    flags["exposure"] = exposure == 0.0 ? "" : QString::number(exposure, 'g', 6).toStdString();
  if (const QString tone = d->ToneBox->currentData().toString(); tone != d->shownTone)
    flags["tone"] = tone == defaultTone ? "" : tone.toStdString();
  return stored;
}
