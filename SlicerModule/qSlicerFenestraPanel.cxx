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

constexpr int pictureSide = 48; ///< pixels of an anatomy's picture

/// Anatomy presets of the renderer, with their names for users.
QList<Choice> anatomies() {
  const auto tr = [](const char* text) { return QObject::tr(text); };
  return {{tr("Knee cartilage (MR)"), "knee-cartilage"},
          {tr("Bones of the foot (CT)"), "foot-bones"},
          {tr("Spine (CT)"), "spine"},
          {tr("Heart (CT)"), "heart"},
          {tr("Lungs and airways (CT)"), "lungs"},
          {tr("Liver (CT)"), "liver"},
          {tr("Brain surface (MR)"), "brain-surface"},
          {tr("Brain tumour (MR)"), "brain-tumour"},
          {tr("Face of a fetus (US)"), "fetal-face"}};
}

QLabel* makeLabel(const QString& name) {
  auto* label = new QLabel;
  label->setObjectName(name);
  label->setTextFormat(Qt::PlainText); // texts of a scene must not be read as HTML
  label->setWordWrap(true);
  label->setTextInteractionFlags(Qt::TextSelectableByMouse);
  return label;
}

QPushButton* button(const QString& name, const QString& text, const QString& help) {
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

QDoubleSpinBox* makeLimitBox(const QString& name, double greatest, int parseDecimals,
                             const QString& suffix) {
  auto* box = new QDoubleSpinBox;
  box->setObjectName(name);
  box->setRange(0.0, greatest);
  box->setDecimals(parseDecimals);
  box->setSuffix(suffix);
  box->setSpecialValueText(QObject::tr("no limit"));
  return box;
}

/// Names each control for screen readers: by its own text, else by its label, else by its tool tip.
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
    // The parts of a box of several widgets bear the box's name.
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
  sample = button("SampleButton", tr("Load a sample knee"),
                  tr("A synthetic knee with its segments, made on this computer"));
  form->addRow(sample);
  volume = makeNodeBox("vtkMRMLScalarVolumeNode", "VolumeBox");
  volume->setNoneEnabled(true);
  volume->setHideChildNodeTypes({"vtkMRMLLabelMapVolumeNode"});
  form->addRow(tr("Volume:"), volume);
  segmentation = makeNodeBox("vtkMRMLSegmentationNode", "SegmentationBox");
  segmentation->setNoneEnabled(true);
  form->addRow(tr("Segmentation:"), segmentation);
  preset = makeComboBox(
      "PresetBox", {{tr("My own choice"), ""}, {tr("By the segments' names"), "auto"}},
      tr("Focus, clipping, tissue colours, light and view for an anatomy, in one; what "
         "you choose yourself wins over it"));
  preset->setIconSize({pictureSide, pictureSide});
  form->addRow(tr("Anatomy:"), preset);
  preset->hide();
  form->labelForField(preset)->hide();
  focus = new QListWidget;
  focus->setObjectName("FocusList");
  focus->setToolTip(tr("Segments that nothing hides"));
  focus->setMaximumHeight(150);
  form->addRow(tr("Focus:"), focus);
  focusHint = makeLabel("FocusHint");
  focusHint->setText(tr("With none ticked, the anatomy's segments are found by their names."));
  focusHint->hide();
  form->addRow(focusHint);
  withheld = makeLabel("WithheldLabel");
  allow = button("AllowButton", tr("Open these files"),
                 tr("Files that the scene names are opened only where you trust who made it"));
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
  preview->setAccessibleName(tr("Preview of the picture"));
  preview->setAlignment(Qt::AlignCenter);
  preview->setMinimumSize(256, 256);
  preview->setStyleSheet("background: black; color: gray");
  layout->addWidget(preview);
  previewState = makeLabel("PreviewStateLabel");
  layout->addWidget(previewState);
}

void qSlicerFenestraPanel::buildRender(QVBoxLayout* layout) {
  auto* row = new QHBoxLayout;
  render = button("RenderButton", tr("Render"), tr("Adds the picture to the scene"));
  stop = button("StopButton", tr("Stop"), tr("Ends the render and keeps its finished samples"));
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
                      tr("Where the picture is taken from"));
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
                         tr("A render ends at the first of its limits"));
  form->addRow(tr("Quality:"), quality);
  samples = makeSpinBox("SamplesBox", 1, 1000000);
  form->addRow(tr("Samples a pixel:"), samples);
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
  degrees->setToolTip(tr("How far around the focus; negative: the other way"));
  form->addRow(tr("Turn:"), degrees);
  steady = new QDoubleSpinBox;
  steady->setObjectName("SteadyBox");
  steady->setRange(0.0, 45.0);
  steady->setDecimals(1);
  steady->setSuffix(tr("\u00b0"));
  steady->setSpecialValueText(tr("each frame by itself"));
  steady->setToolTip(
      tr("Spreads sudden changes of the clipping surface over this part of the turn"));
  form->addRow(tr("Steady surface:"), steady);
  turn = button("TurnButton", tr("Render turntable"),
                tr("Goes around the focus from the view above; each frame is a picture of the "
                   "quality above"));
  form->addRow(turn);
}

void qSlicerFenestraPanel::buildResults(QVBoxLayout* layout) {
  QFormLayout* form = addSection(layout, tr("Pictures"), false);
  renders = makeNodeBox("vtkMRMLFenestraRenderNode", "RendersBox");
  renders->setNoneEnabled(true);
  renders->setRemoveEnabled(true);
  renders->setRenameEnabled(true);
  form->addRow(tr("Picture:"), renders);
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
  show = button("ShowButton", tr("Show"), tr("In a view beside the 3D view"));
  back = button("BackButton", tr("Back"), tr("Shows the views that were there before the picture"));
  repeat = button("RepeatButton", tr("Repeat"), tr("Renders with the same settings again"));
  resume = button("ResumeButton", tr("Continue"),
                  tr("Renders the frames of the turntable that are missing"));
  resume->hide();
  save = button("SaveButton", tr("Save as..."),
                tr("A .png to look at, or an .exr with linear colour and depth; a turntable's "
                   "frames as numbered .png"));
  for (QPushButton* one : {show, back, repeat, resume, save})
    row->addWidget(one);
  form->addRow(row);
}

void qSlicerFenestraPanel::setCapabilities(const qFenestraCapabilities& abilities) {
  const QString best = tr("Best view of the focus");
  setChoiceOffered(view, 1, {best, "auto"}, abilities.hasChoice("view", "auto"));
  const bool presets = abilities.flags.contains("preset");
  showRow(m_subject, preset, presets);
  for (Choice anatomy : anatomies()) {
    const QString picture = ":/Icons/preset-" + anatomy.data + ".png";
    if (QFile::exists(picture))
      anatomy.icon = QIcon(picture);
    setChoiceOffered(preset, preset->count(), anatomy, abilities.mentions("preset", anatomy.data));
  }
  look->setCapabilities(abilities);
  m_materials->setVisible(abilities.flags.contains("material"));
  animation->setVisible(abilities.hasTurntable());
  const bool hasSteady = abilities.turntable.contains("--steady");
  showRow(qobject_cast<QFormLayout*>(animation->layout()), steady, hasSteady);
}

void qSlicerFenestraPanel::offerPresetView(bool chosen) {
  setChoiceOffered(view, 0, {tr("As the anatomy preset"), "preset"}, chosen);
}

void qSlicerFenestraPanel::showWithheld(const std::map<std::string, std::string>& what,
                                        bool files) {
  constexpr std::size_t maxShown = 200; // shown characters of a value
  QStringList lines = {tr("Stored in this scene, but not used:")};
  for (const auto& [name, value] : what)
    lines << QString::fromStdString(name + ": " + value.substr(0, maxShown));
  withheld->setText(lines.join('\n'));
  withheld->setVisible(!what.empty());
  allow->setVisible(files);
}
