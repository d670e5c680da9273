#include "qSlicerFenestraSettings.h"

#include "FenestraFlags.h"
#include "qSlicerFenestra3DViews.h"
#include "qSlicerFenestraWidgets.h"
#include "ui_qSlicerFenestraSettings.h"
#include "vtkMRMLFenestraRenderNode.h"
#include "vtkSlicerFenestraLogic.h"

#include <vtkMRMLCameraNode.h>
#include <vtkMRMLMarkupsPlaneNode.h>
#include <vtkMRMLScene.h>
#include <vtkMRMLSegmentationNode.h>
#include <vtkMRMLVolumeNode.h>
#include <vtkSegment.h>
#include <vtkSegmentation.h>
#include <vtkWeakPointer.h>

#include <QScopedValueRollback>
#include <QStandardItemModel>

#include <algorithm>

using namespace qSlicerFenestraWidgets;

namespace {

using Node = vtkMRMLFenestraRenderNode;
using Flags = std::map<std::string, std::string>;

const char* getId(vtkMRMLNode* node) {
  return node ? node->GetID() : nullptr;
}

/// Shows the items whose texts contain `text`.
void filterItems(const QListWidget* list, const QString& text) {
  for (int i = 0; i < list->count(); ++i)
    list->item(i)->setHidden(!list->item(i)->text().contains(text, Qt::CaseInsensitive));
}

} // namespace

class qSlicerFenestraSettingsPrivate : public Ui_qSlicerFenestraSettings {
  Q_DECLARE_TR_FUNCTIONS(qSlicerFenestraSettings)

public:
  void chooseDefaults();
  bool hasPreset() const { return !node->GetFlag("preset").empty(); }
  vtkMRMLSegmentationNode* segmentationNode() const;
  QList<qSlicerFenestraSegment> listFocusSegments() const;
  void offerPresetView(bool chosen);
  void showSegments();
  void showSubject(const Flags& flags);
  void showWithheld();
  void showView(const Flags& flags);
  void takeView(Flags& flags);
  void store(Flags flags, const QString& viewSize);

  vtkSlicerFenestraLogic* logic = nullptr;
  vtkWeakPointer<Node> node;
  vtkWeakPointer<vtkMRMLNode> volume, segmentation, camera, plane; ///< observed
  bool showing = false; ///< the widgets are being set by the program, not by the user
};

qSlicerFenestraSettings::qSlicerFenestraSettings(QWidget* parent)
    : qMRMLWidget(parent), d_ptr(new qSlicerFenestraSettingsPrivate) {
  using Settings = qSlicerFenestraSettings;
  constexpr auto update = &Settings::updateMRMLFromWidget;
  Q_D(qSlicerFenestraSettings);
  d->setupUi(this);
  setItemData(d->PresetBox, {"", "auto", "knee-cartilage", "foot-bones", "spine", "heart", "lungs",
                             "liver", "brain-surface", "brain-tumor", "fetal-face"});
  setItemIcons(d->PresetBox, "preset");
  setItemData(d->ViewBox,
              {"", "auto", "anterior", "posterior", "left", "right", "superior", "inferior"});
  connect(d->VolumeBox, SIGNAL(currentNodeChanged(vtkMRMLNode*)), this,
          SLOT(takeVolume(vtkMRMLNode*)));
  connect(d->SegmentationBox, SIGNAL(currentNodeChanged(vtkMRMLNode*)), this,
          SLOT(takeSegmentation(vtkMRMLNode*)));
  connect(d->View3DBox, SIGNAL(currentNodeChanged(vtkMRMLNode*)), this,
          SLOT(updateMRMLFromWidget()));
  connect(d->FocusFilter, &QLineEdit::textChanged, this,
          [d](const QString& text) { filterItems(d->FocusList, text); });
  connect(d->FocusList, &QListWidget::itemChanged, this, update);
  connect(d->Clipping, &qSlicerFenestraClipping::changed, this, update);
  connect(d->PresetBox, QOverload<int>::of(&QComboBox::currentIndexChanged), this,
          &Settings::takePreset);
  connect(d->ViewBox, QOverload<int>::of(&QComboBox::currentIndexChanged), this, update);
  connect(d->Look, &qSlicerFenestraLook::changed, this, update);
  connect(d->MaterialsOfSegments, &qSlicerFenestraMaterials::changed, this, update);
  connect(d->AllowButton, &QPushButton::clicked, this, [d] {
    if (d->node)
      d->node->AllowFiles();
  });
  connect(d->FollowBox, &QCheckBox::toggled, this, update);
  connect(d->QualityAndSize, &qSlicerFenestraQuality::changed, this, update);
  connect(d->TurntableOfFocus, &qSlicerFenestraTurntable::changed, this, update);
  connect(d->TurntableOfFocus, &qSlicerFenestraTurntable::turntableRequested, this,
          &Settings::turntableRequested);
  connect(d->ResetButton, &QPushButton::clicked, this, &Settings::reset);
  connect(d->SampleButton, &QPushButton::clicked, this, &Settings::sampleRequested);
}

qSlicerFenestraSettings::~qSlicerFenestraSettings() = default;

void qSlicerFenestraSettings::setLogic(vtkSlicerFenestraLogic* logic) {
  Q_D(qSlicerFenestraSettings);
  d->logic = logic;
}

void qSlicerFenestraSettings::setKnownMaterials(const qFenestraMaterials& known) {
  Q_D(qSlicerFenestraSettings);
  d->MaterialsOfSegments->setKnownMaterials(known);
}

void qSlicerFenestraSettings::setHasVolume(bool has) {
  Q_D(qSlicerFenestraSettings);
  d->SampleButton->setVisible(!has);
  d->TurntableOfFocus->setHasVolume(has);
}

void qSlicerFenestraSettings::setSampleEnabled(bool enabled) {
  Q_D(qSlicerFenestraSettings);
  qSlicerFenestraWidgets::setEnabled(d->SampleButton, enabled, tr("The sample is being generated"));
}

// ---- the node

void qSlicerFenestraSettings::use(Node* node) {
  Q_D(qSlicerFenestraSettings);
  this->qvtkDisconnectAll();
  d->node = node;
  d->volume = d->segmentation = d->camera = d->plane = nullptr;
  d->Clipping->reset();
  d->MaterialsOfSegments->reset();
  if (!d->node)
    return;
  this->qvtkConnect(d->node, vtkCommand::ModifiedEvent, this, SLOT(updateWidgetFromMRML()));
  d->chooseDefaults();
  updateWidgetFromMRML();
  followViewSize();
}

void qSlicerFenestraSettings::reset() {
  Q_D(qSlicerFenestraSettings);
  vtkSlicerFenestraLogic::ResetSettings(d->node);
  use(d->node); // what the widgets remember is reset, too
}

Node* qSlicerFenestraSettings::node() const {
  Q_D(const qSlicerFenestraSettings);
  return d->node;
}

void qSlicerFenestraSettings::copy(Node* render) {
  Q_D(qSlicerFenestraSettings);
  const int wasModifying = d->node->StartModify();
  for (const char* role : {Node::VolumeRole, Node::SegmentationRole, Node::ViewRole})
    d->node->SetNodeReferenceID(role, render->GetNodeReferenceID(role));
  d->node->SetNodeReferenceID(Node::PlaneRole, nullptr); // the plane may have moved
  d->node->SetAttribute(Node::LightsAttribute, render->GetAttribute(Node::LightsAttribute));
  d->node->RemoveAttribute(Node::ViewSizeAttribute); // the view may have changed
  d->node->CopyFlags(render);
  d->node->EndModify(wasModifying);
}

/// Chooses the first volume, segmentation and 3D view that are visible to users.
void qSlicerFenestraSettingsPrivate::chooseDefaults() {
  const auto setDefault = [this](const char* role, const char* className) {
    if (node->GetNodeReference(role))
      return;
    std::vector<vtkMRMLNode*> nodes;
    node->GetScene()->GetNodesByClass(className, nodes);
    for (vtkMRMLNode* one : nodes)
      if (!one->GetHideFromEditors() && !one->IsA("vtkMRMLLabelMapVolumeNode") &&
          !one->IsA("vtkMRMLVectorVolumeNode")) {
        node->SetNodeReferenceID(role, one->GetID());
        return;
      }
  };
  setDefault(Node::VolumeRole, "vtkMRMLScalarVolumeNode");
  setDefault(Node::SegmentationRole, "vtkMRMLSegmentationNode");
  if (!hasPreset()) // a preset may choose the view
    setDefault(Node::ViewRole, "vtkMRMLViewNode");
}

vtkMRMLSegmentationNode* qSlicerFenestraSettingsPrivate::segmentationNode() const {
  return node
             ? vtkMRMLSegmentationNode::SafeDownCast(node->GetNodeReference(Node::SegmentationRole))
             : nullptr;
}

QList<qSlicerFenestraSegment> qSlicerFenestraSettingsPrivate::listFocusSegments() const {
  QList<qSlicerFenestraSegment> focus;
  vtkMRMLSegmentationNode* of = segmentationNode();
  for (const std::string& id : node->GetFocus()) {
    vtkSegment* segment = of ? of->GetSegmentation()->GetSegment(id) : nullptr;
    focus.append({QString::fromStdString(id),
                  segment ? QString::fromUtf8(segment->GetName()) : QString::fromStdString(id)});
  }
  return focus;
}

/// Observes the nodes that the settings reference, instead of those observed before.
void qSlicerFenestraSettings::observe(vtkMRMLNode* volume, vtkMRMLNode* segmentation) {
  Q_D(qSlicerFenestraSettings);
  const auto observe = [this](vtkWeakPointer<vtkMRMLNode>& observed, vtkMRMLNode* node,
                              const std::vector<unsigned long>& events, const char* slot) {
    if (observed == node)
      return;
    for (const unsigned long event : events)
      this->qvtkReconnect(observed, node, event, this, slot);
    observed = node;
  };
  for (const auto& [observed, node] :
       {std::pair(&d->volume, volume), std::pair(&d->segmentation, segmentation)})
    observe(*observed, node, vtkSlicerFenestraLogic::GetDataEvents(), SLOT(onDataChanged()));
  observe(d->camera, d->logic->GetFollowedCamera(d->node), {vtkCommand::ModifiedEvent},
          SIGNAL(changed()));
  observe(d->plane, d->node->GetNodeReference(Node::PlaneRole),
          {vtkCommand::ModifiedEvent, vtkMRMLMarkupsNode::PointModifiedEvent,
           vtkMRMLTransformableNode::TransformModifiedEvent},
          SLOT(onPlaneMoved()));
}

void qSlicerFenestraSettings::onPlaneMoved() {
  Q_D(qSlicerFenestraSettings);
  if (d->node && d->node->GetFlag("clip") == "plane")
    d->node->SetFlag("plane", vtkSlicerFenestraLogic::GetPlaneFlag(d->plane));
}

void qSlicerFenestraSettings::onDataChanged() {
  Q_D(qSlicerFenestraSettings);
  d->showSegments();
  if (d->node && !d->showing) { // a segment may have been removed or restored
    Flags flags = d->node->GetFlags();
    d->MaterialsOfSegments->take(flags);
    d->node->SetFlags(flags);
  }
  emit changed();
}

// ---- from the node to the widgets

void qSlicerFenestraSettings::updateWidgetFromMRML() {
  Q_D(qSlicerFenestraSettings);
  if (!d->node || d->showing)
    return;
  {
    const QScopedValueRollback<bool> guard(d->showing, true);
    const Flags& flags = d->node->GetFlags();
    vtkMRMLNode* volume = d->node->GetNodeReference(Node::VolumeRole);
    vtkMRMLNode* segmentation = d->node->GetNodeReference(Node::SegmentationRole);
    d->VolumeBox->setCurrentNode(volume);
    d->SegmentationBox->setCurrentNode(segmentation);
    observe(volume, segmentation);
    d->showSegments();
    d->showSubject(flags);
    d->MaterialsOfSegments->show(flags);
    d->showWithheld();
    d->showView(flags);
    d->Look->show(flags, d->node->GetAttribute(Node::LightsAttribute), d->hasPreset());
    d->QualityAndSize->show(flags, d->node->GetAttribute(Node::ViewSizeAttribute));
    d->TurntableOfFocus->show(flags);
  }
  emit changed();
}

void qSlicerFenestraSettingsPrivate::showSegments() {
  const QScopedValueRollback<bool> guard(showing, true);
  vtkMRMLSegmentationNode* of = segmentationNode();
  std::vector<std::string> ids, focus;
  if (of) {
    of->GetSegmentation()->GetSegmentIDs(ids);
    focus = node->GetFocus();
  }
  QList<qSlicerFenestraSegment> segments;
  while (FocusList->count() > static_cast<int>(ids.size()))
    delete FocusList->takeItem(FocusList->count() - 1);
  for (size_t i = 0; i < ids.size(); ++i) {
    vtkSegment* segment = of->GetSegmentation()->GetSegment(ids[i]);
    const QString id = QString::fromStdString(ids[i]);
    const QString name = QString::fromUtf8(segment->GetName());
    segments.append({id, name});
    if (static_cast<int>(i) == FocusList->count())
      FocusList->addItem(new QListWidgetItem);
    QListWidgetItem* item = FocusList->item(static_cast<int>(i));
    const double* color = segment->GetColor();
    item->setText(name);
    item->setData(Qt::UserRole, id);
    item->setData(Qt::DecorationRole, QColor::fromRgbF(color[0], color[1], color[2]));
    item->setFlags(Qt::ItemIsEnabled | Qt::ItemIsUserCheckable | Qt::ItemIsSelectable);
    const bool chosen = std::find(focus.begin(), focus.end(), ids[i]) != focus.end();
    item->setCheckState(chosen ? Qt::Checked : Qt::Unchecked);
  }
  filterItems(FocusList, FocusFilter->text());
  const int rows = qBound(3, FocusList->count(), 6); // more scroll
  const int height = qMax(FocusList->sizeHintForRow(0), FocusList->fontMetrics().height());
  FocusList->setFixedHeight(rows * height + 2 * FocusList->frameWidth());
  MaterialsOfSegments->list(segments);
}

/// Adds or removes the view of the anatomy preset.
void qSlicerFenestraSettingsPrivate::offerPresetView(bool chosen) {
  setChoiceOffered(ViewBox, 0, {tr("From the anatomy preset"), "preset"}, chosen);
}

void qSlicerFenestraSettingsPrivate::showSubject(const Flags& flags) {
  using Plane = qSlicerFenestraClipping::Plane;
  const QString stored = findFlag(flags, "preset");
  const QString preset = stored == "brain-tumour" ? "brain-tumor" : stored; // its name in 0.1
  const auto verdict = SlicerExport::checkFlag("preset", preset.toStdString());
  (verdict == SlicerExport::Verdict::file ? selectOrAdd : selectData)(PresetBox, preset);
  offerPresetView(hasPreset());
  FocusHint->setVisible(hasPreset() && node->GetFocus().empty());
  const bool isPlaced = flags.count("plane") > 0;
  Clipping->show(flags,
                 plane      ? Plane::node
                 : isPlaced ? Plane::fixed
                            : Plane::automatic,
                 listFocusSegments(), hasPreset());
}

void qSlicerFenestraSettingsPrivate::showWithheld() {
  constexpr std::size_t maxShown = 200; // characters of a value
  QStringList lines = {tr("Stored in this scene, but not used:")};
  for (const auto& [name, value] : node->GetWithheld())
    lines << QString::fromStdString(name + ": " + value.substr(0, maxShown));
  WithheldLabel->setText(lines.join('\n'));
  WithheldLabel->setVisible(lines.size() > 1);
  AllowButton->setVisible(node->WithholdsFiles());
}

void qSlicerFenestraSettingsPrivate::showView(const Flags& flags) {
  vtkMRMLNode* view3D = node->GetNodeReference(Node::ViewRole);
  const bool byPreset = hasPreset() && !view3D && flags.count("position") == 0;
  const QString word = findFlag(flags, "view");
  selectData(ViewBox, word.isEmpty() && byPreset ? "preset" : word);
  qobject_cast<QStandardItemModel*>(ViewBox->model())
      ->item(ViewBox->findData("auto"))
      ->setEnabled(hasPreset() || !node->GetFocus().empty());
  if (view3D)
    View3DBox->setCurrentNode(view3D);
  const bool fromCamera = selectedData(ViewBox).empty();
  for (QWidget* one : {static_cast<QWidget*>(View3DBox), static_cast<QWidget*>(FollowBox)})
    setEnabled(one, fromCamera, tr("Choose \"As in the 3D view\" above"));
  FollowBox->setChecked(flags.count("position") == 0);
}

// ---- from the widgets to the node

void qSlicerFenestraSettings::updateMRMLFromWidget() {
  Q_D(qSlicerFenestraSettings);
  if (!d->node || d->showing)
    return;
  const int wasModifying = d->node->StartModify();
  std::vector<std::string> focus;
  for (int i = 0; i < d->FocusList->count(); ++i)
    if (d->FocusList->item(i)->checkState() == Qt::Checked)
      focus.push_back(d->FocusList->item(i)->data(Qt::UserRole).toString().toStdString());
  d->node->SetFocus(focus);
  Flags flags = d->node->GetFlags();
  flags["preset"] = selectedData(d->PresetBox);
  vtkMRMLNode* plane = d->Clipping->planeNode();
  d->node->SetNodeReferenceID(Node::PlaneRole, getId(plane));
  const bool byPreset = !flags["preset"].empty();
  d->Clipping->take(flags, vtkSlicerFenestraLogic::GetPlaneFlag(plane),
                    byPreset || !flags["focus"].empty(), byPreset);
  d->takeView(flags);
  d->MaterialsOfSegments->take(flags);
  d->node->SetAttribute(Node::LightsAttribute, d->Look->take(flags).toUtf8().constData());
  d->TurntableOfFocus->take(flags);
  const QString viewSize = d->QualityAndSize->take(flags);
  d->store(flags, viewSize);
  d->node->EndModify(wasModifying);
}

void qSlicerFenestraSettings::followViewSize() {
  Q_D(qSlicerFenestraSettings);
  if (d->node && !d->showing)
    d->store(d->node->GetFlags(), d->node->GetAttribute(Node::ViewSizeAttribute));
}

/// Writes the flags. `viewSize`: of an image "as the 3D view", which gets the view's present size.
void qSlicerFenestraSettingsPrivate::store(Flags flags, const QString& viewSize) {
  const QString size = QualityAndSize->followView(
      flags, viewSize, qSlicerFenestra3DViews::findSize(node->GetNodeReference(Node::ViewRole)));
  const int wasModifying = node->StartModify();
  node->SetAttribute(Node::ViewSizeAttribute, size.isEmpty() ? nullptr : size.toUtf8().constData());
  node->SetFlags(flags);
  node->EndModify(wasModifying);
}

/// Clears the flags that the preset sets; the user may then set them again. Without a preset,
/// restores the defaults.
void qSlicerFenestraSettings::takePreset() {
  Q_D(qSlicerFenestraSettings);
  if (!d->node || d->showing)
    return;
  const bool chosen = !selectedData(d->PresetBox).empty();
  {
    const QScopedValueRollback<bool> guard(d->showing, true);
    d->offerPresetView(chosen);
    if (chosen != d->hasPreset()) {
      d->Clipping->reset();
      selectData(d->ViewBox, chosen ? "preset" : "");
      d->Look->resetToPreset();
    }
  }
  updateMRMLFromWidget();
}

/// Writes the view flags. The camera of a 3D view is followed, or stored as it is now.
void qSlicerFenestraSettingsPrivate::takeView(Flags& flags) {
  const std::string word = selectedData(ViewBox);
  const bool byPreset = word == "preset";
  const bool lacksFocus = flags["preset"].empty() && flags["focus"].empty();
  const std::string view = byPreset || (word == "auto" && lacksFocus) ? "" : word;
  node->SetNodeReferenceID(Node::ViewRole, byPreset ? nullptr : getId(View3DBox->currentNode()));
  const bool frozen = flags.count("position") > 0;
  flags["view"] = view;
  if (view.empty() && !byPreset && !FollowBox->isChecked()) {
    vtkMRMLCameraNode* from = frozen ? nullptr : logic->GetFollowedCamera(node);
    if (from)
      for (const auto& [name, value] : vtkSlicerFenestraLogic::GetCameraFlags(from))
        flags[name] = value;
    return;
  }
  for (const char* name : {"position", "target", "up", "scale", "angle", "projection"})
    flags.erase(name);
}

void qSlicerFenestraSettings::takeVolume(vtkMRMLNode* node) {
  Q_D(qSlicerFenestraSettings);
  if (d->node && !d->showing)
    d->node->SetNodeReferenceID(Node::VolumeRole, getId(node));
}

void qSlicerFenestraSettings::takeSegmentation(vtkMRMLNode* node) {
  Q_D(qSlicerFenestraSettings);
  if (!d->node || d->showing)
    return;
  d->MaterialsOfSegments->reset();
  const int wasModifying = d->node->StartModify();
  d->node->SetNodeReferenceID(Node::SegmentationRole, getId(node));
  d->node->SetFocus({});
  d->node->SetFlag("material", ""); // it refers to the old segmentation's segments
  d->node->EndModify(wasModifying);
}
