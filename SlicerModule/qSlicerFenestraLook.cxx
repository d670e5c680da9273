#include "qSlicerFenestraLook.h"

#include "qFenestraCapabilities.h"
#include "qSlicerFenestraLights.h"
#include "qSlicerFenestraWidgets.h"

#include <ctkSliderWidget.h>

#include <QComboBox>
#include <QDoubleSpinBox>
#include <QFormLayout>
#include <QLabel>
#include <QSignalBlocker>
#include <QStringList>

using namespace qSlicerFenestraWidgets;

namespace {

constexpr const char* defaultTone = "film"; ///< the renderer's default
constexpr double maxStrength = 300.0;       ///< percent

} // namespace

qSlicerFenestraLook::qSlicerFenestraLook(QWidget* parent) : QWidget(parent) {
  m_form = new QFormLayout(this);
  m_form->setContentsMargins(0, 0, 0, 0);
  m_transfer =
      makeComboBox("TransferBox",
                   {{tr("As in Slicer's volume rendering"), ""},
                    {tr("CT: skin and soft tissue"), "ct-soft"},
                    {tr("CT: bones only"), "ct-bone"},
                    {tr("CT: bones and muscle"), "ct-skeleton"},
                    {tr("CT: liver and abdomen"), "ct-liver"},
                    {tr("CT: heart and vessels"), "ct-heart"},
                    {tr("CT: lungs and airways"), "ct-lung"},
                    {tr("MR: brain"), "mr-brain"},
                    {tr("MR: knee cartilage"), "mr-knee"},
                    {tr("Ultrasound: fetus"), "us-fetal"}},
                   tr("Colors and opacities; define your own in the Volume Rendering module"));
  m_form->addRow(tr("Tissue colors:"), m_transfer);
  buildLights(m_form);
  m_background = makeComboBox("BackgroundBox",
                              {{tr("Dark gradient"), "gradient"},
                               {tr("Black"), "0,0,0"},
                               {tr("Gray"), "0.1,0.1,0.1"},
                               {tr("White"), "100,100,100"},
                               {tr("Transparent"), "transparent"}},
                              tr("Behind the volume"));
  m_form->addRow(tr("Background:"), m_background);
  buildDisplay(m_form);
  for (QComboBox* box : {m_transfer, m_rig, m_background, m_tone})
    connect(box, QOverload<int>::of(&QComboBox::currentIndexChanged), this,
            &qSlicerFenestraLook::changed);
  for (ctkSliderWidget* slider : m_strengths)
    connect(slider, &ctkSliderWidget::valueChanged, this, &qSlicerFenestraLook::changed);
  connect(m_exposure, QOverload<double>::of(&QDoubleSpinBox::valueChanged), this,
          &qSlicerFenestraLook::changed);
}

void qSlicerFenestraLook::buildLights(QFormLayout* form) {
  m_rig = makeComboBox("RigBox",
                       {{tr("Default"), ""},
                        {tr("Cinema"), "cinema"},
                        {tr("Studio"), "studio"},
                        {tr("Headlight"), "headlight"},
                        {tr("Soft"), "soft"},
                        {tr("Amber"), "amber"}},
                       tr("Light rig; the default is Cinema"));
  form->addRow(tr("Lights:"), m_rig);
  const QString names[4] = {tr("Key:"), tr("Fill:"), tr("Rim:"), tr("Environment:")};
  for (int i = 0; i < 4; ++i) {
    auto* slider = new ctkSliderWidget;
    slider->setObjectName(QString("Strength%1").arg(i));
    slider->setToolTip(tr("Strength of this light in the rig chosen above"));
    slider->setRange(0.0, maxStrength);
    slider->setDecimals(0);
    slider->setSuffix(" %");
    slider->setValue(100.0);
    form->addRow(names[i], slider);
    m_strengths[i] = slider;
  }
}

void qSlicerFenestraLook::buildDisplay(QFormLayout* form) {
  m_exposure = new QDoubleSpinBox;
  m_exposure->setObjectName("ExposureBox");
  m_exposure->setRange(-4.0, 4.0);
  m_exposure->setDecimals(2);
  m_exposure->setSingleStep(0.25);
  m_exposure->setSuffix(tr(" EV"));
  m_exposure->setToolTip(tr("Makes the image brighter or darker; 1 EV doubles the light. Linear "
                            "colors are not affected"));
  form->addRow(tr("Exposure:"), m_exposure);
  m_tone =
      makeComboBox("ToneBox", {{tr("Film"), defaultTone}, {tr("Photographic"), "photographic"}},
                   tr("Film: more contrast, colors keep their hue. Photographic: dark and medium "
                      "values stay as they are, for measuring"));
  form->addRow(tr("Tone:"), m_tone);
  m_shownTone = defaultTone;
}

void qSlicerFenestraLook::setCapabilities(const qFenestraCapabilities& capabilities) {
  showRow(m_form, m_exposure, capabilities.flags.contains("exposure"));
  showRow(m_form, m_tone, capabilities.flags.contains("tone"));
}

// ---- flags

void qSlicerFenestraLook::show(const Flags& flags, const QString& rig, bool byPreset) {
  const QSignalBlocker blocker(this);
  const QString fromPreset = tr("From the anatomy preset");
  m_transfer->setItemText(m_transfer->findData(""),
                          byPreset ? fromPreset : tr("As in Slicer's volume rendering"));
  m_rig->setItemText(m_rig->findData(""), byPreset ? fromPreset : tr("Default"));
  selectOrAdd(m_transfer, findFlag(flags, "transfer"));
  selectOrAdd(m_background, findFlag(flags, "background"));
  showLights(findFlag(flags, "lights"), rig);
  m_exposure->setValue(findFlag(flags, "exposure").toDouble());
  m_shownExposure = m_exposure->value();
  selectData(m_tone, findFlag(flags, "tone"));
  m_shownTone = m_tone->currentData().toString();
}

void qSlicerFenestraLook::showLights(const QString& lights, const QString& rig) {
  const QStringList parts = rig.split(' ');
  qSlicerFenestraLights::Strengths strengths = qSlicerFenestraLights::unchanged;
  for (std::size_t i = 0; i < strengths.size(); ++i) {
    bool isNumber = false;
    const double percent = parts.value(static_cast<int>(i) + 1).toDouble(&isNumber);
    if (isNumber && percent >= 0.0 && percent <= maxStrength)
      strengths[i] = percent / 100.0;
  }
  const bool isConsistent = m_rig->findData(parts[0]) >= 0 &&
                            qSlicerFenestraLights::makeFlag(parts[0], strengths) == lights;
  selectOrAdd(m_rig, isConsistent ? parts[0] : lights);
  if (!isConsistent)
    strengths = qSlicerFenestraLights::unchanged;
  const auto has = qSlicerFenestraLights::findLights(m_rig->currentData().toString());
  for (std::size_t i = 0; i < strengths.size(); ++i) {
    m_strengths[i]->setValue(100.0 * strengths[i]);
    m_strengths[i]->setEnabled(has[i]);
  }
}

void qSlicerFenestraLook::resetToPreset() {
  const QSignalBlocker blocker(this);
  for (QComboBox* box : {m_transfer, m_rig})
    selectData(box, "");
}

QString qSlicerFenestraLook::take(Flags& flags) const {
  flags["transfer"] = selectedData(m_transfer);
  flags["background"] = selectedData(m_background);
  const QString rig = m_rig->currentData().toString();
  QString stored = rig;
  qSlicerFenestraLights::Strengths strengths{};
  for (std::size_t i = 0; i < strengths.size(); ++i) {
    strengths[i] = m_strengths[i]->value() / 100.0;
    stored += QString(" %1").arg(m_strengths[i]->value());
  }
  flags["lights"] = qSlicerFenestraLights::makeFlag(rig, strengths).toStdString();
  if (const double exposure = m_exposure->value(); exposure != m_shownExposure)
    flags["exposure"] = exposure == 0.0 ? "" : QString::number(exposure, 'g', 6).toStdString();
  if (const QString tone = m_tone->currentData().toString(); tone != m_shownTone)
    flags["tone"] = tone == defaultTone ? "" : tone.toStdString();
  return stored;
}
