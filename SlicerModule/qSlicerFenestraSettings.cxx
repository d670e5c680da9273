#include "qSlicerFenestraSettings.h"

#include "qSlicerFenestraLights.h"
#include "qSlicerFenestraPanel.h"
#include "vtkSlicerFenestraLogic.h"

#include <ctkSliderWidget.h>
#include <qMRMLNodeComboBox.h>

#include <vtkMRMLCameraNode.h>
#include <vtkMRMLScene.h>
#include <vtkMRMLSegmentationNode.h>
#include <vtkMRMLVolumeNode.h>
#include <vtkSegment.h>
#include <vtkSegmentation.h>

#include <QCheckBox>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QListWidget>
#include <QScopedValueRollback>
#include <QSpinBox>

#include <algorithm>

namespace {

using Node = vtkMRMLFenestraRenderNode;
constexpr const char* rigAttribute = "Fenestra.Lights"; ///< "rig key fill rim environment"

void choose(QComboBox* box, const QString& data) {
  const int index = box->findData(data);
  box->setCurrentIndex(index < 0 ? 0 : index);
}

std::string chosenIn(const QComboBox* box) {
  return box->currentData().toString().toStdString();
}

QString flagOf(const std::map<std::string, std::string>& flags, const char* name) {
  const auto found = flags.find(name);
  return found == flags.end() ? QString() : QString::fromStdString(found->second);
}

/// Empty, and so not given, where there is no limit.
std::string limit(double value) {
  return value > 0.0 ? QString::number(value, 'g', 6).toStdString() : std::string();
}

const char* idOf(vtkMRMLNode* node) {
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
  for (QComboBox* box : {panel.clip, panel.view, panel.transfer, panel.rig, panel.background})
    connect(box, QOverload<int>::of(&QComboBox::currentIndexChanged), this, &Settings::take);
  connect(panel.follow, &QCheckBox::toggled, this, &Settings::take);
  for (ctkSliderWidget* slider : panel.strengths)
    connect(slider, &ctkSliderWidget::valueChanged, this, &Settings::take);
  connect(panel.quality, QOverload<int>::of(&QComboBox::currentIndexChanged), this,
          &Settings::takeQuality);
  for (QSpinBox* box : {panel.samples, panel.width, panel.height})
    connect(box, QOverload<int>::of(&QSpinBox::valueChanged), this, &Settings::take);
  for (QDoubleSpinBox* box : {panel.noise, panel.seconds})
    connect(box, QOverload<double>::of(&QDoubleSpinBox::valueChanged), this, &Settings::take);
}

// ---- the node

void qSlicerFenestraSettings::use(Node* node) {
  this->qvtkDisconnectAll();
  m_node = node;
  m_volume = m_segmentation = m_camera = nullptr;
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
  m_node->SetAttribute(rigAttribute, render->GetAttribute(rigAttribute));
  m_node->SetFlags(render->GetFlags());
  m_node->EndModify(wasModifying);
}

/// The first volume, segmentation and 3-D view that a user may choose.
void qSlicerFenestraSettings::chooseDefaults() {
  const auto byDefault = [this](const char* role, const char* className) {
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
  byDefault(Node::VolumeRole, "vtkMRMLScalarVolumeNode");
  byDefault(Node::SegmentationRole, "vtkMRMLSegmentationNode");
  byDefault(Node::ViewRole, "vtkMRMLViewNode");
}

void qSlicerFenestraSettings::watch(vtkWeakPointer<vtkMRMLNode>& watched, vtkMRMLNode* node) {
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

void qSlicerFenestraSettings::watchCamera() {
  vtkMRMLCameraNode* camera = m_logic->GetFollowedCamera(m_node);
  if (m_camera == camera)
    return;
  this->qvtkReconnect(m_camera, camera, vtkCommand::ModifiedEvent, this, SIGNAL(changed()));
  m_camera = camera;
}

void qSlicerFenestraSettings::onDataChanged() {
  showSegments();
  emit changed();
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
    watch(m_volume, volume);
    watch(m_segmentation, segmentation);
    watchCamera();
    showSegments();
    choose(m_panel->clip, flagOf(flags, "clip"));
    choose(m_panel->transfer, flagOf(flags, "transfer"));
    choose(m_panel->background, flagOf(flags, "background"));
    showView(flags);
    showLights(flags);
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

void qSlicerFenestraSettings::showView(const Flags& flags) {
  choose(m_panel->view, flagOf(flags, "view"));
  m_panel->view3D->setCurrentNode(m_node->GetNodeReference(Node::ViewRole));
  const bool fromCamera = flagOf(flags, "view").isEmpty();
  m_panel->view3D->setEnabled(fromCamera);
  m_panel->follow->setEnabled(fromCamera);
  m_panel->follow->setChecked(flags.count("position") == 0);
}

void qSlicerFenestraSettings::showLights(const Flags& flags) {
  const char* stored = m_node->GetAttribute(rigAttribute);
  const QStringList rig =
      stored ? QString(stored).split(' ') : QStringList{flagOf(flags, "lights")};
  choose(m_panel->rig, rig.value(0));
  for (int i = 0; i < 4; ++i)
    m_panel->strengths[i]->setValue(rig.value(i + 1, "100").toDouble());
}

void qSlicerFenestraSettings::showQuality(const Flags& flags) {
  const int samples = flagOf(flags, "samples").toInt();
  const double noise = flagOf(flags, "noise").toDouble();
  const double seconds = flagOf(flags, "seconds").toDouble();
  const int index =
      m_panel->quality->findData(QString("%1 %2 %3").arg(samples).arg(noise).arg(seconds));
  m_panel->quality->setCurrentIndex(index < 0 ? m_panel->quality->count() - 1 : index);
  m_panel->samples->setValue(samples);
  m_panel->noise->setValue(noise);
  m_panel->seconds->setValue(seconds);
  const QStringList size = flagOf(flags, "size").split('x');
  m_panel->width->setValue(size.value(0, "512").toInt());
  m_panel->height->setValue(size.value(1, "512").toInt());
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
  flags["clip"] = focus.empty() ? "" : chosenIn(m_panel->clip); // nothing to clip for
  flags["transfer"] = chosenIn(m_panel->transfer);
  flags["background"] = chosenIn(m_panel->background);
  takeView(flags);
  takeLights(flags);
  flags["samples"] = std::to_string(m_panel->samples->value());
  flags["noise"] = limit(m_panel->noise->value());
  flags["seconds"] = limit(m_panel->seconds->value());
  flags["size"] =
      std::to_string(m_panel->width->value()) + "x" + std::to_string(m_panel->height->value());
  m_node->SetFlags(flags);
  m_node->EndModify(wasModifying);
}

/// Of a 3-D view's camera: followed, or as it is at this moment.
void qSlicerFenestraSettings::takeView(Flags& flags) {
  const std::string view = chosenIn(m_panel->view);
  m_node->SetNodeReferenceID(Node::ViewRole, idOf(m_panel->view3D->currentNode()));
  const bool frozen = flags.count("position") > 0;
  flags["view"] = view;
  if (view.empty() && !m_panel->follow->isChecked()) {
    vtkMRMLCameraNode* camera = frozen ? nullptr : m_logic->GetFollowedCamera(m_node);
    if (camera)
      for (const auto& [name, value] : vtkSlicerFenestraLogic::GetCameraFlags(camera))
        flags[name] = value;
    return;
  }
  for (const char* name : {"position", "target", "up", "scale", "angle", "projection"})
    flags.erase(name);
}

void qSlicerFenestraSettings::takeLights(Flags& flags) {
  const QString rig = m_panel->rig->currentData().toString();
  QString stored = rig;
  qSlicerFenestraLights::Strengths strengths{};
  for (std::size_t i = 0; i < strengths.size(); ++i) {
    strengths[i] = m_panel->strengths[i]->value() / 100.0;
    stored += QString(" %1").arg(m_panel->strengths[i]->value());
  }
  flags["lights"] = qSlicerFenestraLights::flag(rig, strengths).toStdString();
  m_node->SetAttribute(rigAttribute, stored.toUtf8().constData());
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
    m_node->SetNodeReferenceID(Node::VolumeRole, idOf(node));
}

void qSlicerFenestraSettings::takeSegmentation(vtkMRMLNode* node) {
  if (!m_node || m_showing)
    return;
  const int wasModifying = m_node->StartModify();
  m_node->SetNodeReferenceID(Node::SegmentationRole, idOf(node));
  m_node->SetFocus({});
  m_node->EndModify(wasModifying);
}
