#include "qSlicerFenestraPanel.h"

#include "qFenestraCapabilities.h"
#include "qSlicerFenestraClipping.h"
#include "qSlicerFenestraLook.h"
#include "qSlicerFenestraMaterials.h"
#include "qSlicerFenestraPlayer.h"
#include "qSlicerFenestraWidgets.h"

#include <ctkCollapsibleButton.h>
#include <qMRMLNodeComboBox.h>

#include <QCheckBox>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QFile>
#include <QFormLayout>
#include <QHBoxLayout>
#include <QHash>
#include <QLabel>
#include <QListWidget>
#include <QProgressBar>
#include <QPushButton>
#include <QSpinBox>
#include <QToolButton>
#include <QVBoxLayout>

using namespace qSlicerFenestraWidgets;

namespace {

constexpr int iconSide = 48; ///< pixels of a preset's icon

/// Anatomy presets of the renderer with their display names.
QList<Choice> listAnatomies() {
  const auto tr = [](const char* text) { return QObject::tr(text); };
  return {{tr("Knee cartilage (MR)"), "knee-cartilage"},
          {tr("Bones of the foot (CT)"), "foot-bones"},
          {tr("Spine (CT)"), "spine"},
          {tr("Heart (CT)"), "heart"},
          {tr("Lungs and airways (CT)"), "lungs"},
          {tr("Liver (CT)"), "liver"},
          {tr("Brain surface (MR)"), "brain-surface"},
          {tr("Brain tumor (MR)"), "brain-tumor"},
          {tr("Face of a fetus (US)"), "fetal-face"}};
}

QLabel* makeLabel(const QString& name) {
  auto* label = new QLabel;
  label->setObjectName(name);
  label->setTextFormat(Qt::PlainText); // texts from a scene must not be read as HTML
  label->setWordWrap(true);
  label->setTextInteractionFlags(Qt::TextSelectableByMouse);
  return label;
}

QPushButton* makeButton(const QString& name, const QString& text, const QString& help) {
  auto* one = new QPushButton(text);
  one->setObjectName(name);
  one->setToolTip(help);
  return one;
}

QSpinBox* makeSpinBox(const QString& name, int least, int greatest) {
  auto* box = new QSpinBox;
  box->setObjectName(name);
  box->setRange(least, greatest);
  return box;
}

QDoubleSpinBox* makeLimitBox(const QString& name, double greatest, int decimals,
                             const QString& suffix) {
  auto* box = new QDoubleSpinBox;
  box->setObjectName(name);
  box->setRange(0.0, greatest);
  box->setDecimals(decimals);
  box->setSuffix(suffix);
  box->setSpecialValueText(QObject::tr("no limit"));
  return box;
}

/// Names each control for screen readers: by its own text, else its label, else its tool tip.
void nameControls(QWidget* panel) {
  QHash<const QWidget*, QString> labels;
  for (const QLabel* label : panel->findChildren<QLabel*>())
    if (label->buddy())
      labels[label->buddy()] = label->text();
  for (QWidget* control : panel->findChildren<QWidget*>()) {
    if (control->focusPolicy() == Qt::NoFocus || !control->accessibleName().isEmpty())
      continue;
    const auto* button = qobject_cast<QAbstractButton*>(control);
    QString name = button ? button->text() : QString();
    // The parts of a compound widget take the widget's name.
    for (const QWidget* one = control; one != panel && name.isEmpty(); one = one->parentWidget())
      name = labels.contains(one) ? labels.value(one) : one->toolTip();
    control->setAccessibleName(name.remove('&'));
  }
}

} // namespace

qSlicerFenestraPanel::qSlicerFenestraPanel(QWidget* parent) : QWidget(parent) {
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  buildPreview(layout);
  buildRender(layout);
  buildSubject(layout);
  buildMaterials(layout);
  buildView(layout);
  buildQuality(layout);
  buildAnimation(layout);
  buildResults(layout);
  layout->addStretch(1);
  nameControls(this);
}

QFormLayout* qSlicerFenestraPanel::addSection(QVBoxLayout* layout, const QString& title,
                                              bool collapsed) {
  auto* one = new ctkCollapsibleButton(title);
  one->setCollapsed(collapsed);
  one->setObjectName(title);
  layout->addWidget(one);
  return new QFormLayout(one);
}

qMRMLNodeComboBox* qSlicerFenestraPanel::makeNodeBox(const QString& type, const QString& name) {
  auto* box = new qMRMLNodeComboBox;
  box->setObjectName(name);
  box->setNodeTypes({type});
  box->setAddEnabled(false);
  box->setRemoveEnabled(false);
  box->setRenameEnabled(false);
  connect(this, SIGNAL(mrmlSceneChanged(vtkMRMLScene*)), box, SLOT(setMRMLScene(vtkMRMLScene*)));
  return box;
}

void qSlicerFenestraPanel::buildSubject(QVBoxLayout* layout) {
  QFormLayout* form = addSection(layout, tr("What to show"), false);
  m_subject = form;
  sample = makeButton("SampleButton", tr("Load a sample knee"),
                      tr("A synthetic knee with segments, generated on this computer"));
  form->addRow(sample);
  volume = makeNodeBox("vtkMRMLScalarVolumeNode", "VolumeBox");
  volume->setNoneEnabled(true);
  volume->setHideChildNodeTypes({"vtkMRMLLabelMapVolumeNode"});
  form->addRow(tr("Volume:"), volume);
  segmentation = makeNodeBox("vtkMRMLSegmentationNode", "SegmentationBox");
  segmentation->setNoneEnabled(true);
  form->addRow(tr("Segmentation:"), segmentation);
  preset = makeComboBox(
      "PresetBox", {{tr("Custom"), ""}, {tr("By segment names"), "auto"}},
      tr("Sets focus, clipping, tissue colors, light and view for an anatomy; your own "
         "choices override it"));
  preset->setIconSize({iconSide, iconSide});
  form->addRow(tr("Anatomy:"), preset);
  preset->hide();
  form->labelForField(preset)->hide();
  focus = new QListWidget;
  focus->setObjectName("FocusList");
  focus->setToolTip(tr("Segments to show unobstructed"));
  focus->setMaximumHeight(150);
  form->addRow(tr("Focus:"), focus);
  focusHint = makeLabel("FocusHint");
  focusHint->setText(tr("If no segment is checked, the preset finds its segments by name."));
  focusHint->hide();
  form->addRow(focusHint);
  withheld = makeLabel("WithheldLabel");
  allow = makeButton("AllowButton", tr("Open these files"),
                     tr("The scene names these files. Open them only if you trust its author"));
  for (QWidget* one : {static_cast<QWidget*>(withheld), static_cast<QWidget*>(allow)}) {
    one->hide();
    form->addRow(one);
  }
  clipping = new qSlicerFenestraClipping(makeNodeBox("vtkMRMLMarkupsPlaneNode", "PlaneNodeBox"));
  clipping->setObjectName("Clipping");
  form->addRow(clipping);
}

void qSlicerFenestraPanel::buildMaterials(QVBoxLayout* layout) {
  QFormLayout* form = addSection(layout, tr("Materials"), true);
  m_materials = form->parentWidget();
  m_materials->hide();
  materials = new qSlicerFenestraMaterials;
  materials->setObjectName("MaterialsOfSegments");
  form->addRow(materials);
}

void qSlicerFenestraPanel::buildPreview(QVBoxLayout* layout) {
  showPreview = new QCheckBox(tr("Preview"));
  showPreview->setObjectName("PreviewBox");
  showPreview->setChecked(true);
  layout->addWidget(showPreview);
  preview = new QLabel;
  preview->setObjectName("PreviewLabel");
  preview->setAccessibleName(tr("Preview of the image"));
  preview->setAlignment(Qt::AlignCenter);
  preview->setMinimumSize(256, 256);
  preview->setStyleSheet("background: black; color: gray");
  layout->addWidget(preview);
  previewState = makeLabel("PreviewStateLabel");
  layout->addWidget(previewState);
}

void qSlicerFenestraPanel::buildRender(QVBoxLayout* layout) {
  auto* row = new QHBoxLayout;
  render =
      makeButton("RenderButton", tr("Render"), tr("Renders an image and adds it to the scene"));
  stop =
      makeButton("StopButton", tr("Stop"), tr("Stops the render and keeps its finished samples"));
  stop->setEnabled(false);
  row->addWidget(render, 2);
  row->addWidget(stop, 1);
  layout->addLayout(row);
  progress = new QProgressBar;
  progress->setObjectName("ProgressBar");
  progress->setRange(0, 1000);
  progress->hide();
  layout->addWidget(progress);
  state = makeLabel("StateLabel");
  layout->addWidget(state);
  details = new QToolButton;
  details->setObjectName("DetailsButton");
  details->setText(tr("Details"));
  details->setCheckable(true);
  details->hide();
  layout->addWidget(details);
  detailsText = makeLabel("DetailsLabel");
  detailsText->hide();
  layout->addWidget(detailsText);
  connect(details, &QToolButton::toggled, detailsText, &QLabel::setVisible);
}

void qSlicerFenestraPanel::buildView(QVBoxLayout* layout) {
  QFormLayout* form = addSection(layout, tr("View and light"), false);
  view = makeComboBox("ViewBox",
                      {{tr("As in the 3D view"), ""},
                       {tr("From anterior"), "anterior"},
                       {tr("From posterior"), "posterior"},
                       {tr("From left"), "left"},
                       {tr("From right"), "right"},
                       {tr("From superior"), "superior"},
                       {tr("From inferior"), "inferior"}},
                      tr("Viewpoint of the image"));
  form->addRow(tr("View:"), view);
  view3D = makeNodeBox("vtkMRMLViewNode", "View3DBox");
  follow = new QCheckBox(tr("live"));
  follow->setObjectName("FollowBox");
  follow->setChecked(true);
  follow->setToolTip(tr("The preview follows the 3D view as you turn it"));
  auto* row = new QHBoxLayout;
  row->addWidget(view3D, 1);
  row->addWidget(follow);
  form->addRow(tr("3D view:"), row);
  look = new qSlicerFenestraLook;
  look->setObjectName("Look");
  form->addRow(look);
}

void qSlicerFenestraPanel::buildQuality(QVBoxLayout* layout) {
  QFormLayout* form = addSection(layout, tr("Quality"), true);
  quality = makeComboBox("QualityBox",
                         {{tr("Draft"), "16 0 0"},
                          {tr("Good"), "256 0.05 0"},
                          {tr("Final"), "4096 0.015 0"},
                          {tr("Custom"), ""}},
                         tr("A render ends at the first limit that it reaches"));
  form->addRow(tr("Quality:"), quality);
  samples = makeSpinBox("SamplesBox", 1, 1000000);
  form->addRow(tr("Samples per pixel:"), samples);
  noise = makeLimitBox("NoiseBox", 1.0, 3, {});
  noise->setSingleStep(0.005);
  form->addRow(tr("Noise:"), noise);
  seconds = makeLimitBox("SecondsBox", 86400.0, 0, tr(" s"));
  form->addRow(tr("Time:"), seconds);
  auto* row = new QHBoxLayout;
  width = makeSpinBox("WidthBox", 16, 8192);
  height = makeSpinBox("HeightBox", 16, 8192);
  row->addWidget(width, 1);
  row->addWidget(new QLabel(QString::fromUtf8("\u00d7")));
  row->addWidget(height, 1);
  form->addRow(tr("Size in pixels:"), row);
}

void qSlicerFenestraPanel::buildAnimation(QVBoxLayout* layout) {
  QFormLayout* form = addSection(layout, tr("Turntable"), true);
  animation = form->parentWidget();
  animation->hide();
  frames = makeSpinBox("FramesBox", 1, 3600);
  frames->setValue(36);
  form->addRow(tr("Frames:"), frames);
  degrees = new QDoubleSpinBox;
  degrees->setObjectName("DegreesBox");
  degrees->setRange(-3600.0, 3600.0);
  degrees->setDecimals(1);
  degrees->setValue(360.0);
  degrees->setSuffix(tr("\u00b0"));
  degrees->setToolTip(tr("Angle around the focus; negative: the other direction"));
  form->addRow(tr("Rotation:"), degrees);
  steady = new QDoubleSpinBox;
  steady->setObjectName("SteadyBox");
  steady->setRange(0.0, 45.0);
  steady->setDecimals(1);
  steady->setSuffix(tr("\u00b0"));
  steady->setSpecialValueText(tr("off"));
  steady->setToolTip(
      tr("Spreads sudden changes of the clipping surface over this part of the rotation"));
  form->addRow(tr("Surface smoothing:"), steady);
  turn = makeButton("TurnButton", tr("Render turntable"),
                    tr("Rotates around the focus, starting at the view above; each frame has the "
                       "quality above"));
  form->addRow(turn);
}

void qSlicerFenestraPanel::buildResults(QVBoxLayout* layout) {
  QFormLayout* form = addSection(layout, tr("Images"), false);
  renders = makeNodeBox("vtkMRMLFenestraRenderNode", "RendersBox");
  renders->setNoneEnabled(true);
  renders->setRemoveEnabled(true);
  renders->setRenameEnabled(true);
  form->addRow(tr("Image:"), renders);
  description = makeLabel("DescriptionLabel");
  form->addRow(description);
  player = new qSlicerFenestraPlayer;
  player->setObjectName("Player");
  player->hide();
  form->addRow(player);
  measures = makeLabel("MeasuresLabel");
  measures->setTextFormat(Qt::RichText);
  form->addRow(measures);
  auto* row = new QHBoxLayout;
  show = makeButton("ShowButton", tr("Show"), tr("Shows the image beside the 3D view"));
  back = makeButton("BackButton", tr("Back"),
                    tr("Restores the views from before the image was shown"));
  repeat = makeButton("RepeatButton", tr("Repeat"), tr("Renders with the same settings again"));
  resume =
      makeButton("ResumeButton", tr("Continue"), tr("Renders the missing frames of the turntable"));
  resume->hide();
  save =
      makeButton("SaveButton", tr("Save as..."),
                 tr("A .png for display, or an .exr with linear color and depth; the frames of a "
                    "turntable as numbered .png"));
  for (QPushButton* one : {show, back, repeat, resume, save})
    row->addWidget(one);
  form->addRow(row);
}

void qSlicerFenestraPanel::setCapabilities(const qFenestraCapabilities& capabilities) {
  const QString best = tr("Best view of the focus");
  setChoiceOffered(view, 1, {best, "auto"}, capabilities.hasChoice("view", "auto"));
  const bool presets = capabilities.flags.contains("preset");
  showRow(m_subject, preset, presets);
  for (Choice anatomy : listAnatomies()) {
    const QString icon = ":/Icons/preset-" + anatomy.data + ".png";
    if (QFile::exists(icon))
      anatomy.icon = QIcon(icon);
    setChoiceOffered(preset, preset->count(), anatomy,
                     capabilities.mentions("preset", anatomy.data));
  }
  look->setCapabilities(capabilities);
  m_materials->setVisible(capabilities.flags.contains("material"));
  animation->setVisible(capabilities.hasTurntable());
  const bool hasSteady = capabilities.turntable.contains("--steady");
  showRow(qobject_cast<QFormLayout*>(animation->layout()), steady, hasSteady);
}

void qSlicerFenestraPanel::offerPresetView(bool chosen) {
  setChoiceOffered(view, 0, {tr("From the anatomy preset"), "preset"}, chosen);
}

void qSlicerFenestraPanel::showWithheld(const std::map<std::string, std::string>& what,
                                        bool files) {
  constexpr std::size_t maxShown = 200; // characters of a value
  QStringList lines = {tr("Stored in this scene, but not used:")};
  for (const auto& [name, value] : what)
    lines << QString::fromStdString(name + ": " + value.substr(0, maxShown));
  withheld->setText(lines.join('\n'));
  withheld->setVisible(!what.empty());
  allow->setVisible(files);
}
