#include "qSlicerFenestraModuleWidget.h"

#include "qSlicerFenestraLights.h"
#include "qSlicerFenestraModule.h"
#include "qSlicerFenestraPanel.h"
#include "vtkMRMLFenestraRenderNode.h"
#include "vtkSlicerFenestraLogic.h"

#include <ctkSliderWidget.h>
#include <qMRMLNodeComboBox.h>
#include <qSlicerCoreApplication.h>
#include <qSlicerCoreIOManager.h>

#include <vtkMRMLCameraNode.h>
#include <vtkMRMLScalarVolumeNode.h>
#include <vtkMRMLScene.h>
#include <vtkMRMLSegmentationNode.h>
#include <vtkMRMLViewNode.h>
#include <vtkSegment.h>
#include <vtkSegmentation.h>

#include <QCheckBox>
#include <QComboBox>
#include <QDir>
#include <QDoubleSpinBox>
#include <QFile>
#include <QFileDialog>
#include <QLabel>
#include <QListWidget>
#include <QProgressBar>
#include <QPushButton>
#include <QSpinBox>
#include <QTimer>
#include <QToolButton>
#include <QVBoxLayout>

#include <cmath>

namespace {

using Node = vtkMRMLFenestraRenderNode;
constexpr const char* rigAttribute = "Fenestra.Lights"; ///< "rig key fill rim environment"

QString duration(double seconds) {
  const int whole = static_cast<int>(std::lround(std::min(seconds, 1e6)));
  if (whole < 60)
    return QObject::tr("%1 s").arg(whole);
  return QObject::tr("%1 min %2 s").arg(whole / 60).arg(whole % 60);
}

void choose(QComboBox* box, const QString& data) {
  const int index = box->findData(data);
  box->setCurrentIndex(index < 0 ? 0 : index);
}

QString flagOf(const std::map<std::string, std::string>& flags, const char* name) {
  const auto found = flags.find(name);
  return found == flags.end() ? QString() : QString::fromStdString(found->second);
}

std::string text(double value) {
  return QString::number(value, 'g', 6).toStdString();
}

} // namespace

qSlicerFenestraModuleWidget::qSlicerFenestraModuleWidget(QWidget* parent) : Superclass(parent) {}

qSlicerFenestraModuleWidget::~qSlicerFenestraModuleWidget() {
  delete m_session; // its signals would find a panel that is half gone
}

vtkSlicerFenestraLogic* qSlicerFenestraModuleWidget::fenestra() const {
  return vtkSlicerFenestraLogic::SafeDownCast(this->logic());
}

void qSlicerFenestraModuleWidget::setup() {
  Superclass::setup();
  auto* layout = new QVBoxLayout(this);
  m_panel = new qSlicerFenestraPanel;
  layout->addWidget(m_panel);
  QString program;
  if (auto* own = dynamic_cast<qSlicerFenestraModule*>(this->module()))
    program = own->program();
  m_session = new qSlicerFenestraSession(fenestra(), program, this);
  connectPanel();
  connectSession();
  updateButtons();
}

void qSlicerFenestraModuleWidget::connectPanel() {
  const qSlicerFenestraPanel& panel = *m_panel;
  connect(panel.sample, &QPushButton::clicked, this, &qSlicerFenestraModuleWidget::loadSample);
  connect(panel.volume, SIGNAL(currentNodeChanged(vtkMRMLNode*)), this,
          SLOT(onVolumeChosen(vtkMRMLNode*)));
  connect(panel.segmentation, SIGNAL(currentNodeChanged(vtkMRMLNode*)), this,
          SLOT(onSegmentationChosen(vtkMRMLNode*)));
  connect(panel.renders, SIGNAL(currentNodeChanged(vtkMRMLNode*)), this,
          SLOT(onPictureChosen(vtkMRMLNode*)));
  connect(panel.focus, &QListWidget::itemChanged, this, &qSlicerFenestraModuleWidget::takeSettings);
  for (QComboBox* box : {panel.clip, panel.view, panel.transfer, panel.rig, panel.background})
    connect(box, QOverload<int>::of(&QComboBox::currentIndexChanged), this,
            &qSlicerFenestraModuleWidget::takeSettings);
  connect(panel.view3D, SIGNAL(currentNodeChanged(vtkMRMLNode*)), this, SLOT(takeSettings()));
  connect(panel.follow, &QCheckBox::toggled, this, &qSlicerFenestraModuleWidget::takeSettings);
  for (ctkSliderWidget* slider : panel.strengths)
    connect(slider, &ctkSliderWidget::valueChanged, this,
            &qSlicerFenestraModuleWidget::takeSettings);
  connect(panel.quality, QOverload<int>::of(&QComboBox::currentIndexChanged), this,
          &qSlicerFenestraModuleWidget::takeQuality);
  for (QSpinBox* box : {panel.samples, panel.width, panel.height})
    connect(box, QOverload<int>::of(&QSpinBox::valueChanged), this,
            &qSlicerFenestraModuleWidget::takeSettings);
  for (QDoubleSpinBox* box : {panel.noise, panel.seconds})
    connect(box, QOverload<double>::of(&QDoubleSpinBox::valueChanged), this,
            &qSlicerFenestraModuleWidget::takeSettings);
  connect(panel.showPreview, &QCheckBox::toggled, this, [this](bool shown) {
    m_panel->preview->setVisible(shown);
    m_panel->previewState->setVisible(shown);
    m_session->preview(shown && this->isEntered() ? settings() : nullptr);
  });
  connect(panel.render, &QPushButton::clicked, this, &qSlicerFenestraModuleWidget::render);
  connect(panel.stop, &QPushButton::clicked, m_session, &qSlicerFenestraSession::stop);
  connect(panel.repeat, &QPushButton::clicked, this, &qSlicerFenestraModuleWidget::repeat);
  connect(panel.show, &QPushButton::clicked, this, [this] {
    if (chosen())
      showResult(chosen());
  });
  connect(panel.save, &QPushButton::clicked, this, &qSlicerFenestraModuleWidget::save);
}

void qSlicerFenestraModuleWidget::connectSession() {
  connect(m_session, &qSlicerFenestraSession::previewed, this,
          &qSlicerFenestraModuleWidget::showPicture);
  connect(m_session, &qSlicerFenestraSession::previewRefused, m_panel->previewState,
          &QLabel::setText);
  connect(m_session, &qSlicerFenestraSession::started, this, [this](Node*) {
    m_reached.clear();
    say(tr("Rendering..."));
    updateButtons();
  });
  connect(m_session, &qSlicerFenestraSession::reached, this,
          [this](const QString& words) { m_reached = words; });
  connect(m_session, &qSlicerFenestraSession::progressed, this,
          [this](Node*, double part, double seconds) { onProgress(part, seconds); });
  connect(m_session, &qSlicerFenestraSession::ended, this, &qSlicerFenestraModuleWidget::onEnded);
}

// ---- the scene

void qSlicerFenestraModuleWidget::setMRMLScene(vtkMRMLScene* scene) {
  this->qvtkReconnect(this->mrmlScene(), scene, vtkMRMLScene::EndCloseEvent, this,
                      SLOT(onSceneReset()));
  this->qvtkReconnect(this->mrmlScene(), scene, vtkMRMLScene::EndImportEvent, this,
                      SLOT(onSceneReset()));
  Superclass::setMRMLScene(scene);
  emit m_panel->mrmlSceneChanged(scene);
  if (this->isEntered())
    useScene();
}

void qSlicerFenestraModuleWidget::enter() {
  Superclass::enter();
  useScene();
}

void qSlicerFenestraModuleWidget::exit() {
  m_session->preview(nullptr);
  Superclass::exit();
}

void qSlicerFenestraModuleWidget::onSceneReset() {
  if (this->isEntered())
    useScene();
}

void qSlicerFenestraModuleWidget::useScene() {
  if (!this->mrmlScene() || this->mrmlScene()->IsBatchProcessing())
    return;
  m_settings = fenestra()->GetSettings();
  this->qvtkDisconnectAll();
  this->qvtkConnect(this->mrmlScene(), vtkMRMLScene::EndCloseEvent, this, SLOT(onSceneReset()));
  this->qvtkConnect(this->mrmlScene(), vtkMRMLScene::EndImportEvent, this, SLOT(onSceneReset()));
  m_volume = m_segmentation = m_camera = nullptr;
  if (!m_settings)
    return;
  this->qvtkConnect(m_settings, vtkCommand::ModifiedEvent, this, SLOT(showSettings()));
  chooseDefaults();
  showSettings();
  m_session->preview(m_panel->showPreview->isChecked() ? settings() : nullptr);
}

/// What a user would choose first: a volume that is rendered already, the first segmentation.
void qSlicerFenestraModuleWidget::chooseDefaults() {
  const auto byDefault = [this](const char* role, const char* className) {
    if (m_settings->GetNodeReference(role))
      return;
    std::vector<vtkMRMLNode*> nodes;
    this->mrmlScene()->GetNodesByClass(className, nodes);
    for (vtkMRMLNode* node : nodes)
      if (!node->GetHideFromEditors() && !node->IsA("vtkMRMLLabelMapVolumeNode") &&
          !node->IsA("vtkMRMLVectorVolumeNode")) {
        m_settings->SetNodeReferenceID(role, node->GetID());
        return;
      }
  };
  byDefault(Node::VolumeRole, "vtkMRMLScalarVolumeNode");
  byDefault(Node::SegmentationRole, "vtkMRMLSegmentationNode");
  byDefault(Node::ViewRole, "vtkMRMLViewNode");
}

void qSlicerFenestraModuleWidget::watch(const char* role, vtkMRMLNode* node) {
  vtkWeakPointer<vtkMRMLNode>& watched = role == Node::VolumeRole ? m_volume : m_segmentation;
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

void qSlicerFenestraModuleWidget::watchCamera() {
  vtkMRMLCameraNode* camera = fenestra()->GetFollowedCamera(m_settings);
  if (m_camera == camera)
    return;
  this->qvtkReconnect(m_camera, camera, vtkCommand::ModifiedEvent, m_session, SLOT(refresh()));
  m_camera = camera;
}

void qSlicerFenestraModuleWidget::onDataChanged() {
  showSegments();
  m_session->refresh();
}

void qSlicerFenestraModuleWidget::onVolumeChosen(vtkMRMLNode* node) {
  if (m_settings && !m_showing)
    m_settings->SetNodeReferenceID(Node::VolumeRole, node ? node->GetID() : nullptr);
}

void qSlicerFenestraModuleWidget::onSegmentationChosen(vtkMRMLNode* node) {
  if (!m_settings || m_showing)
    return;
  const int wasModifying = m_settings->StartModify();
  m_settings->SetNodeReferenceID(Node::SegmentationRole, node ? node->GetID() : nullptr);
  m_settings->SetFocus({});
  m_settings->EndModify(wasModifying);
}

void qSlicerFenestraModuleWidget::onPictureChosen(vtkMRMLNode*) {
  updateButtons();
}

// ---- settings

void qSlicerFenestraModuleWidget::showSegments() {
  auto* node = m_settings ? vtkMRMLSegmentationNode::SafeDownCast(
                                m_settings->GetNodeReference(Node::SegmentationRole))
                          : nullptr;
  const std::vector<std::string> focus =
      m_settings ? m_settings->GetFocus() : std::vector<std::string>();
  const bool wasShowing = m_showing;
  m_showing = true;
  std::vector<std::string> ids;
  if (node)
    node->GetSegmentation()->GetSegmentIDs(ids);
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
  m_showing = wasShowing;
}

void qSlicerFenestraModuleWidget::showQuality(const std::map<std::string, std::string>& flags) {
  const QString quality = QString("%1 %2 %3")
                              .arg(flagOf(flags, "samples").toInt())
                              .arg(flagOf(flags, "noise").toDouble())
                              .arg(flagOf(flags, "seconds").toDouble());
  const int index = m_panel->quality->findData(quality);
  m_panel->quality->setCurrentIndex(index < 0 ? m_panel->quality->count() - 1 : index);
  m_panel->samples->setValue(flagOf(flags, "samples").toInt());
  m_panel->noise->setValue(flagOf(flags, "noise").toDouble());
  m_panel->seconds->setValue(flagOf(flags, "seconds").toDouble());
  const QStringList size = flagOf(flags, "size").split('x');
  m_panel->width->setValue(size.value(0, "512").toInt());
  m_panel->height->setValue(size.value(1, "512").toInt());
}

void qSlicerFenestraModuleWidget::showSettings() {
  if (!m_settings || m_showing)
    return;
  m_showing = true;
  const std::map<std::string, std::string>& flags = m_settings->GetFlags();
  vtkMRMLNode* volume = m_settings->GetNodeReference(Node::VolumeRole);
  vtkMRMLNode* segmentation = m_settings->GetNodeReference(Node::SegmentationRole);
  m_panel->volume->setCurrentNode(volume);
  m_panel->segmentation->setCurrentNode(segmentation);
  watch(Node::VolumeRole, volume);
  watch(Node::SegmentationRole, segmentation);
  watchCamera();
  showSegments();
  choose(m_panel->clip, flagOf(flags, "clip"));
  choose(m_panel->view, flagOf(flags, "view"));
  m_panel->view3D->setCurrentNode(m_settings->GetNodeReference(Node::ViewRole));
  const bool fromCamera = flagOf(flags, "view").isEmpty();
  m_panel->view3D->setEnabled(fromCamera);
  m_panel->follow->setEnabled(fromCamera);
  m_panel->follow->setChecked(flags.count("position") == 0);
  choose(m_panel->transfer, flagOf(flags, "transfer"));
  choose(m_panel->background, flagOf(flags, "background"));
  const char* stored = m_settings->GetAttribute(rigAttribute);
  const QStringList rig = QString(stored ? stored : "studio 100 100 100 100").split(' ');
  choose(m_panel->rig, rig.value(0));
  for (int i = 0; i < 4; ++i)
    m_panel->strengths[i]->setValue(rig.value(i + 1, "100").toDouble());
  showQuality(flags);
  m_showing = false;
  updateButtons();
  m_session->refresh();
}

/// Of a 3-D view's camera: followed, or as it is at this moment.
void qSlicerFenestraModuleWidget::takeView(std::map<std::string, std::string>& flags) {
  const std::string view = m_panel->view->currentData().toString().toStdString();
  vtkMRMLNode* view3D = m_panel->view3D->currentNode();
  m_settings->SetNodeReferenceID(Node::ViewRole, view3D ? view3D->GetID() : nullptr);
  const bool frozen = flags.count("position") > 0;
  flags["view"] = view;
  if (view.empty() && !m_panel->follow->isChecked()) {
    vtkMRMLCameraNode* camera = frozen ? nullptr : fenestra()->GetFollowedCamera(m_settings);
    if (camera)
      for (const auto& [name, value] : vtkSlicerFenestraLogic::GetCameraFlags(camera))
        flags[name] = value;
    return;
  }
  for (const char* name : {"position", "target", "up", "scale", "angle", "projection"})
    flags.erase(name);
}

void qSlicerFenestraModuleWidget::takeSettings() {
  if (!m_settings || m_showing)
    return;
  const int wasModifying = m_settings->StartModify();
  std::vector<std::string> focus;
  for (int i = 0; i < m_panel->focus->count(); ++i)
    if (m_panel->focus->item(i)->checkState() == Qt::Checked)
      focus.push_back(m_panel->focus->item(i)->data(Qt::UserRole).toString().toStdString());
  m_settings->SetFocus(focus);
  std::map<std::string, std::string> flags = m_settings->GetFlags();
  const std::string clip = m_panel->clip->currentData().toString().toStdString();
  flags["clip"] = focus.empty() ? "" : clip; // nothing to clip for
  takeView(flags);
  flags["transfer"] = m_panel->transfer->currentData().toString().toStdString();
  flags["background"] = m_panel->background->currentData().toString().toStdString();
  qSlicerFenestraLights::Strengths strengths{};
  QString rig = m_panel->rig->currentData().toString();
  QString stored = rig;
  for (std::size_t i = 0; i < strengths.size(); ++i) {
    strengths[i] = m_panel->strengths[i]->value() / 100.0;
    stored += QString(" %1").arg(m_panel->strengths[i]->value());
  }
  flags["lights"] = qSlicerFenestraLights::flag(rig, strengths).toStdString();
  m_settings->SetAttribute(rigAttribute, stored.toUtf8().constData());
  flags["samples"] = std::to_string(m_panel->samples->value());
  flags["noise"] = m_panel->noise->value() > 0.0 ? text(m_panel->noise->value()) : "";
  flags["seconds"] = m_panel->seconds->value() > 0.0 ? text(m_panel->seconds->value()) : "";
  flags["size"] =
      std::to_string(m_panel->width->value()) + "x" + std::to_string(m_panel->height->value());
  m_settings->SetFlags(flags);
  m_settings->EndModify(wasModifying);
  m_session->setPreviewSize(QSize(m_panel->width->value(), m_panel->height->value())
                                .scaled(256, 256, Qt::KeepAspectRatio)
                                .expandedTo({16, 16}));
}

void qSlicerFenestraModuleWidget::takeQuality() {
  const QStringList numbers = m_panel->quality->currentData().toString().split(' ');
  if (m_showing || numbers.size() != 3)
    return;
  m_showing = true;
  m_panel->samples->setValue(numbers[0].toInt());
  m_panel->noise->setValue(numbers[1].toDouble());
  m_panel->seconds->setValue(numbers[2].toDouble());
  m_showing = false;
  takeSettings();
}

// ---- renders

Node* qSlicerFenestraModuleWidget::chosen() const {
  return Node::SafeDownCast(m_panel->renders->currentNode());
}

void qSlicerFenestraModuleWidget::render() {
  if (!m_settings)
    return;
  m_session->render(m_settings);
  updateButtons();
}

/// Twice: a view that the layout has just made takes the picture when it has its size.
void qSlicerFenestraModuleWidget::showResult(Node* render) {
  fenestra()->ShowResult(render);
  const vtkWeakPointer<Node> shown = render;
  QTimer::singleShot(0, this, [this, shown] {
    if (shown && shown->GetScene())
      fenestra()->ShowResult(shown);
  });
}

void qSlicerFenestraModuleWidget::repeat() {
  Node* render = chosen();
  if (!render || !m_settings)
    return;
  const int wasModifying = m_settings->StartModify();
  for (const char* role : {Node::VolumeRole, Node::SegmentationRole, Node::ViewRole})
    m_settings->SetNodeReferenceID(role, render->GetNodeReferenceID(role));
  m_settings->SetAttribute(rigAttribute, render->GetAttribute(rigAttribute));
  m_settings->SetFlags(render->GetFlags());
  m_settings->EndModify(wasModifying);
  this->render();
}

void qSlicerFenestraModuleWidget::showPicture(const QImage& picture, const qFenestraPicture& what) {
  m_panel->preview->setPixmap(QPixmap::fromImage(picture));
  const QString noise = what.noise < 0.0 ? QString() : tr(", noise %1").arg(what.noise, 0, 'g', 2);
  m_panel->previewState->setText(tr("Preview: %1 samples a pixel%2, %3 s")
                                     .arg(what.samples)
                                     .arg(noise)
                                     .arg(what.seconds, 0, 'f', 1));
}

void qSlicerFenestraModuleWidget::onProgress(double part, double seconds) {
  m_panel->progress->show();
  m_panel->progress->setValue(static_cast<int>(1000.0 * part));
  QString line = tr("%1 so far").arg(duration(seconds));
  if (part > 0.01)
    line += tr(", %1 to go").arg(duration(seconds * (1.0 - part) / part));
  if (!m_reached.isEmpty())
    line += ", " + m_reached;
  if (m_session->waiting() > 0)
    line += tr("; %n more waiting", nullptr, m_session->waiting());
  say(line);
}

void qSlicerFenestraModuleWidget::onEnded(Node* render, const qFenestraOutcome& outcome) {
  m_panel->progress->hide();
  if (outcome.kind == qFenestraOutcome::Kind::failed)
    say(outcome.message, outcome.details);
  else if (!render)
    say(tr("Stopped before there was a picture."));
  else
    say((outcome.kind == qFenestraOutcome::Kind::stopped ? tr("Stopped: %1.") : tr("Done: %1."))
            .arg(QString::fromUtf8(render->GetDescription() ? render->GetDescription() : "")));
  if (render) {
    m_panel->renders->setCurrentNode(render);
    showResult(render);
  }
  updateButtons();
}

void qSlicerFenestraModuleWidget::say(const QString& message, const QString& details) {
  m_panel->state->setText(message);
  m_panel->detailsText->setText(details);
  m_panel->details->setVisible(!details.isEmpty());
  m_panel->details->setChecked(false);
}

void qSlicerFenestraModuleWidget::updateButtons() {
  const bool hasVolume = m_settings && m_settings->GetNodeReference(Node::VolumeRole);
  m_panel->render->setEnabled(hasVolume);
  m_panel->sample->setVisible(!hasVolume);
  if (!hasVolume)
    m_panel->preview->setText(tr("Load a volume, or the sample knee"));
  m_panel->stop->setEnabled(m_session->rendering());
  Node* render = chosen();
  const bool hasPicture = render && render->GetNodeReference(Node::PictureRole);
  m_panel->show->setEnabled(hasPicture);
  m_panel->save->setEnabled(hasPicture);
  m_panel->repeat->setEnabled(render != nullptr);
  const char* description = render ? render->GetDescription() : nullptr;
  m_panel->description->setText(QString::fromUtf8(description ? description : ""));
}

// ---- files

void qSlicerFenestraModuleWidget::save() {
  Node* render = chosen();
  const QString png = tr("Picture (*.png)"), exr = tr("All channels (*.exr)");
  QString filter;
  QString file = QFileDialog::getSaveFileName(this, tr("Save the picture"),
                                              QString::fromUtf8(render->GetName()) + ".png",
                                              png + ";;" + exr, &filter);
  if (file.isEmpty())
    return;
  const QString ending = file.endsWith(".exr", Qt::CaseInsensitive) ? "exr" : "png";
  if (!file.endsWith("." + ending, Qt::CaseInsensitive))
    file += "." + ending;
  const QString source = m_session->fileOf(render, ending);
  if (source.isEmpty())
    return say(tr("The picture's file went with the session that made it. Press Repeat, then "
                  "save."));
  QFile::remove(file);
  if (!QFile::copy(source, file))
    return say(tr("%1 could not be written. Choose another folder.").arg(file));
  say(tr("Saved as %1.").arg(file));
}

void qSlicerFenestraModuleWidget::loadSample() {
  m_session->makeSample([this](const QString& scene, const QString& message) {
    if (scene.isEmpty())
      return say(tr("The sample could not be made."), message);
    qSlicerIO::IOProperties properties;
    properties["fileName"] = scene;
    properties["clear"] = false;
    qSlicerCoreApplication::application()->coreIOManager()->loadNodes("SceneFile", properties);
    say(tr("A synthetic knee. Choose a segment as focus."));
  });
}
