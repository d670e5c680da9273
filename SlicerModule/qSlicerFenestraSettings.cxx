#include "qSlicerFenestraSettings.h"

#include "FenestraFlags.h"
#include "qSlicerFenestraClipping.h"
#include "qSlicerFenestraLook.h"
#include "qSlicerFenestraMaterials.h"
#include "qSlicerFenestraPanel.h"
#include "qSlicerFenestraWidgets.h"
#include "vtkSlicerFenestraLogic.h"

#include <qMRMLNodeComboBox.h>

#include <vtkMRMLCameraNode.h>
#include <vtkMRMLMarkupsPlaneNode.h>
#include <vtkMRMLScene.h>
#include <vtkMRMLSegmentationNode.h>
#include <vtkMRMLVolumeNode.h>
#include <vtkSegment.h>
#include <vtkSegmentation.h>

#include <QCheckBox>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QLabel>
#include <QListWidget>
#include <QPushButton>
#include <QScopedValueRollback>
#include <QSpinBox>
#include <QStandardItemModel>

#include <algorithm>

using namespace qSlicerFenestraWidgets;

namespace {

using Node = vtkMRMLFenestraRenderNode;
constexpr const char* rigAttribute = "Fenestra.Lights"; ///< value: "rig key fill rim environment"

/// Flag value of a limit; empty (not passed): no limit.
std::string toLimitFlag(double value) {
  return value > 0.0 ? QString::number(value, 'g', 6).toStdString() : std::string();
}

const char* getId(vtkMRMLNode* node) {
  return node ? node->GetID() : nullptr;
}

} // namespace

qSlicerFenestraSettings::qSlicerFenestraSettings(qSlicerFenestraPanel* panel,
                                                 vtkSlicerFenestraLogic* logic, QObject* parent)
    : QObject(parent), m_panel(panel), m_logic(logic) {
  connectPanel();
}

void qSlicerFenestraSettings::connectPanel() {
  using Settings = qSlicerFenestraSettings;
  const qSlicerFenestraPanel& panel = *m_panel;
  connect(panel.volume, SIGNAL(currentNodeChanged(vtkMRMLNode*)), this,
          SLOT(takeVolume(vtkMRMLNode*)));
  connect(panel.segmentation, SIGNAL(currentNodeChanged(vtkMRMLNode*)), this,
          SLOT(takeSegmentation(vtkMRMLNode*)));
  connect(panel.view3D, SIGNAL(currentNodeChanged(vtkMRMLNode*)), this, SLOT(take()));
  connect(panel.focus, &QListWidget::itemChanged, this, &Settings::take);
  connect(panel.clipping, &qSlicerFenestraClipping::changed, this, &Settings::take);
  connect(panel.preset, QOverload<int>::of(&QComboBox::currentIndexChanged), this,
          &Settings::takePreset);
  connect(panel.view, QOverload<int>::of(&QComboBox::currentIndexChanged), this, &Settings::take);
  connect(panel.look, &qSlicerFenestraLook::changed, this, &Settings::take);
  connect(panel.materials, &qSlicerFenestraMaterials::changed, this, &Settings::take);
  connect(panel.allow, &QPushButton::clicked, this, [this] {
    if (m_node)
      m_node->AllowFiles();
  });
  connect(panel.follow, &QCheckBox::toggled, this, &Settings::take);
  connect(panel.quality, QOverload<int>::of(&QComboBox::currentIndexChanged), this,
          &Settings::takeQuality);
  for (QSpinBox* box : {panel.samples, panel.width, panel.height, panel.frames})
    connect(box, QOverload<int>::of(&QSpinBox::valueChanged), this, &Settings::take);
  for (QDoubleSpinBox* box : {panel.noise, panel.seconds, panel.degrees, panel.steady})
    connect(box, QOverload<double>::of(&QDoubleSpinBox::valueChanged), this, &Settings::take);
}

// ---- the node

void qSlicerFenestraSettings::use(Node* node) {
  this->qvtkDisconnectAll();
  m_node = node;
  m_volume = m_segmentation = m_camera = m_plane = nullptr;
  m_panel->clipping->reset();
  m_panel->materials->reset();
  if (!m_node)
    return;
  this->qvtkConnect(m_node, vtkCommand::ModifiedEvent, this, SLOT(show()));
  chooseDefaults();
  show();
}

void qSlicerFenestraSettings::copy(Node* render) {
  const int wasModifying = m_node->StartModify();
  for (const char* role : {Node::VolumeRole, Node::SegmentationRole, Node::ViewRole})
    m_node->SetNodeReferenceID(role, render->GetNodeReferenceID(role));
  m_node->SetNodeReferenceID(Node::PlaneRole, nullptr); // the plane may have moved
  m_node->SetAttribute(rigAttribute, render->GetAttribute(rigAttribute));
  m_node->CopyFlags(render);
  m_node->EndModify(wasModifying);
}

/// Chooses the first volume, segmentation and 3D view that are visible to users.
void qSlicerFenestraSettings::chooseDefaults() {
  const auto setDefault = [this](const char* role, const char* className) {
    if (m_node->GetNodeReference(role))
      return;
    std::vector<vtkMRMLNode*> nodes;
    m_node->GetScene()->GetNodesByClass(className, nodes);
    for (vtkMRMLNode* node : nodes)
      if (!node->GetHideFromEditors() && !node->IsA("vtkMRMLLabelMapVolumeNode") &&
          !node->IsA("vtkMRMLVectorVolumeNode")) {
        m_node->SetNodeReferenceID(role, node->GetID());
        return;
      }
  };
  setDefault(Node::VolumeRole, "vtkMRMLScalarVolumeNode");
  setDefault(Node::SegmentationRole, "vtkMRMLSegmentationNode");
  if (!hasPreset()) // a preset may choose the view
    setDefault(Node::ViewRole, "vtkMRMLViewNode");
}

bool qSlicerFenestraSettings::hasPreset() const {
  return !m_node->GetFlag("preset").empty();
}

QList<qSlicerFenestraSegment> qSlicerFenestraSettings::listFocusSegments() const {
  QList<qSlicerFenestraSegment> focus;
  auto* node =
      vtkMRMLSegmentationNode::SafeDownCast(m_node->GetNodeReference(Node::SegmentationRole));
  for (const std::string& id : m_node->GetFocus()) {
    vtkSegment* segment = node ? node->GetSegmentation()->GetSegment(id) : nullptr;
    focus.append({QString::fromStdString(id),
                  segment ? QString::fromUtf8(segment->GetName()) : QString::fromStdString(id)});
  }
  return focus;
}

void qSlicerFenestraSettings::observe(vtkWeakPointer<vtkMRMLNode>& watched, vtkMRMLNode* node) {
  if (watched == node)
    return;
  const unsigned long events[] = {vtkCommand::ModifiedEvent,
                                  vtkMRMLVolumeNode::ImageDataModifiedEvent,
                                  vtkMRMLTransformableNode::TransformModifiedEvent,
                                  vtkMRMLDisplayableNode::DisplayModifiedEvent,
                                  vtkSegmentation::RepresentationModified,
                                  vtkSegmentation::SegmentAdded,
                                  vtkSegmentation::SegmentRemoved,
                                  vtkSegmentation::SegmentModified};
  for (const unsigned long event : events)
    this->qvtkReconnect(watched, node, event, this, SLOT(onDataChanged()));
  watched = node;
}

void qSlicerFenestraSettings::observeCamera() {
  vtkMRMLCameraNode* camera = m_logic->GetFollowedCamera(m_node);
  if (m_camera == camera)
    return;
  this->qvtkReconnect(m_camera, camera, vtkCommand::ModifiedEvent, this, SIGNAL(changed()));
  m_camera = camera;
}

void qSlicerFenestraSettings::observePlane() {
  vtkMRMLNode* plane = m_node->GetNodeReference(Node::PlaneRole);
  if (m_plane == plane)
    return;
  for (const unsigned long event :
       {(unsigned long)vtkCommand::ModifiedEvent,
        (unsigned long)vtkMRMLMarkupsNode::PointModifiedEvent,
        (unsigned long)vtkMRMLTransformableNode::TransformModifiedEvent})
    this->qvtkReconnect(m_plane, plane, event, this, SLOT(onPlaneMoved()));
  m_plane = plane;
}

void qSlicerFenestraSettings::onPlaneMoved() {
  if (m_node && m_node->GetFlag("clip") == "plane")
    m_node->SetFlag("plane", vtkSlicerFenestraLogic::GetPlaneFlag(m_plane));
}

void qSlicerFenestraSettings::onDataChanged() {
  showSegments();
  takeMaterials();
  emit changed();
}

/// Updates only the material flags, since a segment may have been removed or restored.
void qSlicerFenestraSettings::takeMaterials() {
  if (!m_node || m_showing)
    return;
  Flags flags = m_node->GetFlags();
  m_panel->materials->take(flags);
  m_node->SetFlags(flags);
}

// ---- from the node to the panel

void qSlicerFenestraSettings::show() {
  if (!m_node || m_showing)
    return;
  {
    const QScopedValueRollback<bool> showing(m_showing, true);
    const Flags& flags = m_node->GetFlags();
    vtkMRMLNode* volume = m_node->GetNodeReference(Node::VolumeRole);
    vtkMRMLNode* segmentation = m_node->GetNodeReference(Node::SegmentationRole);
    m_panel->volume->setCurrentNode(volume);
    m_panel->segmentation->setCurrentNode(segmentation);
    observe(m_volume, volume);
    observe(m_segmentation, segmentation);
    observeCamera();
    observePlane();
    showSegments();
    showSubject(flags);
    m_panel->materials->show(flags);
    m_panel->showWithheld(m_node->GetWithheld(), m_node->WithholdsFiles());
    showView(flags);
    m_panel->look->show(flags, m_node->GetAttribute(rigAttribute), hasPreset());
    showQuality(flags);
  }
  emit changed();
}

void qSlicerFenestraSettings::showSegments() {
  const QScopedValueRollback<bool> showing(m_showing, true);
  auto* node =
      m_node
          ? vtkMRMLSegmentationNode::SafeDownCast(m_node->GetNodeReference(Node::SegmentationRole))
          : nullptr;
  std::vector<std::string> ids, focus;
  if (node) {
    node->GetSegmentation()->GetSegmentIDs(ids);
    focus = m_node->GetFocus();
  }
  QList<qSlicerFenestraSegment> segments;
  for (const std::string& id : ids)
    segments.append({QString::fromStdString(id),
                     QString::fromUtf8(node->GetSegmentation()->GetSegment(id)->GetName())});
  m_panel->materials->list(segments);
  QListWidget& list = *m_panel->focus;
  while (list.count() > static_cast<int>(ids.size()))
    delete list.takeItem(list.count() - 1);
  for (size_t i = 0; i < ids.size(); ++i) {
    vtkSegment* segment = node->GetSegmentation()->GetSegment(ids[i]);
    if (static_cast<int>(i) == list.count())
      list.addItem(new QListWidgetItem);
    QListWidgetItem* item = list.item(static_cast<int>(i));
    const double* color = segment->GetColor();
    item->setText(QString::fromUtf8(segment->GetName()));
    item->setData(Qt::UserRole, QString::fromStdString(ids[i]));
    item->setData(Qt::DecorationRole, QColor::fromRgbF(color[0], color[1], color[2]));
    item->setFlags(Qt::ItemIsEnabled | Qt::ItemIsUserCheckable | Qt::ItemIsSelectable);
    const bool chosen = std::find(focus.begin(), focus.end(), ids[i]) != focus.end();
    item->setCheckState(chosen ? Qt::Checked : Qt::Unchecked);
  }
}

void qSlicerFenestraSettings::showSubject(const Flags& flags) {
  using Plane = qSlicerFenestraClipping::Plane;
  const QString stored = findFlag(flags, "preset");
  const QString preset = stored == "brain-tumour" ? "brain-tumor" : stored; // its name in 0.1
  const auto verdict = SlicerExport::checkFlag("preset", preset.toStdString());
  (verdict == SlicerExport::Verdict::file ? selectOrAdd : selectData)(m_panel->preset, preset);
  m_panel->offerPresetView(hasPreset());
  m_panel->focusHint->setVisible(hasPreset() && m_node->GetFocus().empty());
  const bool isPlaced = flags.count("plane") > 0;
  m_panel->clipping->show(flags,
                          m_plane    ? Plane::node
                          : isPlaced ? Plane::fixed
                                     : Plane::automatic,
                          listFocusSegments(), hasPreset());
}

void qSlicerFenestraSettings::showView(const Flags& flags) {
  vtkMRMLNode* view3D = m_node->GetNodeReference(Node::ViewRole);
  const bool byPreset = hasPreset() && !view3D && flags.count("position") == 0;
  const QString word = findFlag(flags, "view");
  selectData(m_panel->view, word.isEmpty() && byPreset ? "preset" : word);
  if (auto* model = qobject_cast<QStandardItemModel*>(m_panel->view->model()))
    if (const int best = m_panel->view->findData("auto"); best >= 0)
      model->item(best)->setEnabled(hasPreset() || !m_node->GetFocus().empty());
  if (view3D)
    m_panel->view3D->setCurrentNode(view3D);
  const bool fromCamera = m_panel->view->currentData().toString().isEmpty();
  m_panel->view3D->setEnabled(fromCamera);
  m_panel->follow->setEnabled(fromCamera);
  m_panel->follow->setChecked(flags.count("position") == 0);
}

void qSlicerFenestraSettings::showQuality(const Flags& flags) {
  const int samples = findFlag(flags, "samples").toInt();
  const double noise = findFlag(flags, "noise").toDouble();
  const double seconds = findFlag(flags, "seconds").toDouble();
  const int index =
      m_panel->quality->findData(QString("%1 %2 %3").arg(samples).arg(noise).arg(seconds));
  m_panel->quality->setCurrentIndex(index < 0 ? m_panel->quality->count() - 1 : index);
  m_panel->samples->setValue(samples);
  m_panel->noise->setValue(noise);
  m_panel->seconds->setValue(seconds);
  const QStringList size = findFlag(flags, "size").split('x');
  m_panel->width->setValue(size.value(0, "512").toInt());
  m_panel->height->setValue(size.value(1, "512").toInt());
  if (flags.count("frames") == 0) // flags of a repeated image, not of a turntable
    return;
  m_panel->frames->setValue(findFlag(flags, "frames").toInt());
  m_panel->degrees->setValue(flags.count("degrees") > 0 ? findFlag(flags, "degrees").toDouble()
                                                        : 360.0);
  m_panel->steady->setValue(findFlag(flags, "steady").toDouble());
}

// ---- from the panel to the node

void qSlicerFenestraSettings::take() {
  if (!m_node || m_showing)
    return;
  const int wasModifying = m_node->StartModify();
  std::vector<std::string> focus;
  for (int i = 0; i < m_panel->focus->count(); ++i)
    if (m_panel->focus->item(i)->checkState() == Qt::Checked)
      focus.push_back(m_panel->focus->item(i)->data(Qt::UserRole).toString().toStdString());
  m_node->SetFocus(focus);
  Flags flags = m_node->GetFlags();
  flags["preset"] = selectedData(m_panel->preset);
  takeClipping(flags);
  takeView(flags);
  m_panel->materials->take(flags);
  m_node->SetAttribute(rigAttribute, m_panel->look->take(flags).toUtf8().constData());
  flags["samples"] = std::to_string(m_panel->samples->value());
  flags["noise"] = toLimitFlag(m_panel->noise->value());
  flags["seconds"] = toLimitFlag(m_panel->seconds->value());
  flags["size"] =
      std::to_string(m_panel->width->value()) + "x" + std::to_string(m_panel->height->value());
  flags["frames"] = std::to_string(m_panel->frames->value());
  flags["degrees"] = QString::number(m_panel->degrees->value()).toStdString();
  flags["steady"] = toLimitFlag(m_panel->steady->value());
  m_node->SetFlags(flags);
  m_node->EndModify(wasModifying);
}

void qSlicerFenestraSettings::takeClipping(Flags& flags) {
  const qSlicerFenestraClipping& clipping = *m_panel->clipping;
  const bool isNode = clipping.plane() == qSlicerFenestraClipping::Plane::node;
  vtkMRMLNode* plane = isNode ? clipping.planeNode()->currentNode() : nullptr;
  m_node->SetNodeReferenceID(Node::PlaneRole, getId(plane));
  const bool byPreset = !flags["preset"].empty();
  clipping.take(flags, vtkSlicerFenestraLogic::GetPlaneFlag(plane),
                byPreset || !flags["focus"].empty(), byPreset);
}

/// Clears the flags that the preset sets; the user may then set them again. Without a preset,
/// restores the defaults.
void qSlicerFenestraSettings::takePreset() {
  if (!m_node || m_showing)
    return;
  const bool chosen = !selectedData(m_panel->preset).empty();
  {
    const QScopedValueRollback<bool> showing(m_showing, true);
    m_panel->offerPresetView(chosen);
    if (chosen != hasPreset()) {
      m_panel->clipping->reset();
      selectData(m_panel->view, chosen ? "preset" : "");
      m_panel->look->resetToPreset();
    }
  }
  take();
}

/// Writes the view flags. The camera of a 3D view is followed, or stored as it is now.
void qSlicerFenestraSettings::takeView(Flags& flags) {
  const std::string word = selectedData(m_panel->view);
  const bool byPreset = word == "preset";
  const bool lacksFocus = flags["preset"].empty() && flags["focus"].empty();
  const std::string view = byPreset || (word == "auto" && lacksFocus) ? "" : word;
  m_node->SetNodeReferenceID(Node::ViewRole,
                             byPreset ? nullptr : getId(m_panel->view3D->currentNode()));
  const bool frozen = flags.count("position") > 0;
  flags["view"] = view;
  if (view.empty() && !byPreset && !m_panel->follow->isChecked()) {
    vtkMRMLCameraNode* camera = frozen ? nullptr : m_logic->GetFollowedCamera(m_node);
    if (camera)
      for (const auto& [name, value] : vtkSlicerFenestraLogic::GetCameraFlags(camera))
        flags[name] = value;
    return;
  }
  for (const char* name : {"position", "target", "up", "scale", "angle", "projection"})
    flags.erase(name);
}

void qSlicerFenestraSettings::takeQuality() {
  const QStringList numbers = m_panel->quality->currentData().toString().split(' ');
  if (m_showing || numbers.size() != 3)
    return;
  {
    const QScopedValueRollback<bool> showing(m_showing, true);
    m_panel->samples->setValue(numbers[0].toInt());
    m_panel->noise->setValue(numbers[1].toDouble());
    m_panel->seconds->setValue(numbers[2].toDouble());
  }
  take();
}

void qSlicerFenestraSettings::takeVolume(vtkMRMLNode* node) {
  if (m_node && !m_showing)
    m_node->SetNodeReferenceID(Node::VolumeRole, getId(node));
}

void qSlicerFenestraSettings::takeSegmentation(vtkMRMLNode* node) {
  if (!m_node || m_showing)
    return;
  m_panel->materials->reset();
  const int wasModifying = m_node->StartModify();
  m_node->SetNodeReferenceID(Node::SegmentationRole, getId(node));
  m_node->SetFocus({});
  m_node->SetFlag("material", ""); // it refers to the old segmentation's segments
  m_node->EndModify(wasModifying);
}
