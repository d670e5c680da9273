#include "qSlicerFenestraModuleWidget.h"

#include "qFenestraCopies.h"
#include "qSlicerFenestraMaterials.h"
#include "qSlicerFenestraMeasures.h"
#include "qSlicerFenestraModule.h"
#include "qSlicerFenestraPanel.h"
#include "qSlicerFenestraPlayer.h"
#include "qSlicerFenestraSettings.h"
#include "vtkMRMLFenestraRenderNode.h"
#include "vtkSlicerFenestraLogic.h"

#include <qMRMLNodeComboBox.h>
#include <qMRMLThreeDWidget.h>
#include <qSlicerApplication.h>
#include <qSlicerCoreIOManager.h>
#include <qSlicerLayoutManager.h>

#include <vtkMRMLScene.h>

#include <QCheckBox>
#include <QFileDialog>
#include <QJsonDocument>
#include <QLabel>
#include <QMessageBox>
#include <QProgressBar>
#include <QPushButton>
#include <QSignalBlocker>
#include <QTimer>
#include <QToolButton>
#include <QVBoxLayout>

#include <cmath>

namespace {

using Node = vtkMRMLFenestraRenderNode;

/// Size with the aspect ratio of the first 3D view and about `side` x `side` pixels; empty: no
/// view.
std::string findViewSize(double side) {
  const qSlicerApplication* application = qSlicerApplication::application();
  qSlicerLayoutManager* layout = application ? application->layoutManager() : nullptr;
  const QWidget* view = layout ? layout->threeDWidget(0) : nullptr;
  if (!view || view->width() < 64 || view->height() < 64) // hidden or collapsed
    return {};
  const double scale = side / std::sqrt(double(view->width()) * view->height());
  const auto scaled = [scale](int length) { return std::to_string(std::lround(scale * length)); };
  return scaled(view->width()) + "x" + scaled(view->height());
}

} // namespace

qSlicerFenestraModuleWidget::qSlicerFenestraModuleWidget(QWidget* parent) : Superclass(parent) {}

qSlicerFenestraModuleWidget::~qSlicerFenestraModuleWidget() {
  if (m_session) { // the module owns it and keeps it running
    m_session->preview(nullptr);
    m_session->disconnect(this);
  }
}

vtkSlicerFenestraLogic* qSlicerFenestraModuleWidget::fenestraLogic() const {
  return vtkSlicerFenestraLogic::SafeDownCast(this->logic());
}

void qSlicerFenestraModuleWidget::setup() {
  Superclass::setup();
  auto* layout = new QVBoxLayout(this);
  m_panel = new qSlicerFenestraPanel;
  layout->addWidget(m_panel);
  m_settings = new qSlicerFenestraSettings(m_panel, fenestraLogic(), this);
  m_session = dynamic_cast<qSlicerFenestraModule*>(this->module())->session();
  connectPanel();
  connectSession();
  m_session->queryCapabilities();
  updateButtons();
}

void qSlicerFenestraModuleWidget::connectPanel() {
  const qSlicerFenestraPanel& panel = *m_panel;
  connect(panel.sample, &QPushButton::clicked, this, &qSlicerFenestraModuleWidget::loadSample);
  connect(panel.renders, SIGNAL(currentNodeChanged(vtkMRMLNode*)), this, SLOT(onRenderChosen()));
  connect(panel.showPreview, &QCheckBox::toggled, this, [this](bool shown) {
    m_panel->preview->setVisible(shown);
    m_panel->previewState->setVisible(shown);
    preview();
  });
  connect(panel.render, &QPushButton::clicked, this, &qSlicerFenestraModuleWidget::render);
  connect(panel.turn, &QPushButton::clicked, this, &qSlicerFenestraModuleWidget::renderTurntable);
  connect(panel.resume, &QPushButton::clicked, this, [this] {
    m_session->resume(chosenRender());
    updateButtons();
  });
  connect(panel.player, &qSlicerFenestraPlayer::frameChanged, this, [this](int frame) {
    if (chosenRender())
      fenestraLogic()->ShowFrame(chosenRender(), frame);
  });
  connect(panel.stop, &QPushButton::clicked, this, &qSlicerFenestraModuleWidget::stop);
  connect(panel.repeat, &QPushButton::clicked, this, &qSlicerFenestraModuleWidget::repeat);
  connect(panel.show, &QPushButton::clicked, this, [this] {
    clearStatus();
    showResult(chosenRender());
  });
  connect(panel.back, &QPushButton::clicked, this, [this] { fenestraLogic()->ShowLayoutBefore(); });
  connect(panel.save, &QPushButton::clicked, this, &qSlicerFenestraModuleWidget::save);
}

void qSlicerFenestraModuleWidget::connectSession() {
  connect(m_settings, &qSlicerFenestraSettings::changed, this, [this] {
    m_session->queryMaterials(vtkSlicerFenestraLogic::GetSegments(m_settings->node()));
    updateButtons();
    preview();
  });
  connect(m_session, &qSlicerFenestraSession::capabilitiesReceived, this,
          [this](const qFenestraCapabilities& capabilities) {
            m_panel->setCapabilities(capabilities);
            m_settings->use(m_settings->node());
          });
  connect(m_session, &qSlicerFenestraSession::materialsReceived, m_panel->materials,
          &qSlicerFenestraMaterials::setKnownMaterials);
  connect(m_session, &qSlicerFenestraSession::previewReceived, this,
          &qSlicerFenestraModuleWidget::showPreviewImage);
  connect(m_session, &qSlicerFenestraSession::previewRefused, m_panel->previewState,
          &QLabel::setText);
  connect(m_session, &qSlicerFenestraSession::started, this, [this](Node*) {
    m_samplesAndNoise.clear();
    m_progressAge.invalidate();
    setStatus(tr("Rendering..."));
    updateButtons();
  });
  connect(m_session, &qSlicerFenestraSession::statusChanged, this,
          [this](const QString& text) { m_samplesAndNoise = text; });
  connect(m_session, &qSlicerFenestraSession::progressed, this,
          [this](Node*, double fraction, double seconds) { onProgress(fraction, seconds); });
  connect(m_session, &qSlicerFenestraSession::ended, this, &qSlicerFenestraModuleWidget::onEnded);
}

// ---- the scene

void qSlicerFenestraModuleWidget::setMRMLScene(vtkMRMLScene* scene) {
  vtkMRMLScene* const before = this->mrmlScene();
  this->qvtkReconnect(before, scene, vtkMRMLScene::EndCloseEvent, this, SLOT(onSceneClosed()));
  this->qvtkReconnect(before, scene, vtkMRMLScene::EndImportEvent, this, SLOT(onSceneImported()));
  this->qvtkReconnect(before, scene, vtkMRMLScene::EndBatchProcessEvent, this, SLOT(useNewScene()));
  Superclass::setMRMLScene(scene);
  emit m_panel->mrmlSceneChanged(scene);
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

/// Clears messages about the scene; the module closes the session's scene.
void qSlicerFenestraModuleWidget::onSceneClosed() {
  m_sceneIsNew = true;
  clearStatus();
}

void qSlicerFenestraModuleWidget::onSceneImported() {
  m_sceneIsNew = true;
}

/// Called at the end of a batch: earlier, the panel's boxes lack the nodes, and opening a scene
/// closes the old one in the same batch.
void qSlicerFenestraModuleWidget::useNewScene() {
  if (m_sceneIsNew)
    useScene();
}

void qSlicerFenestraModuleWidget::useScene() {
  if (!this->isEntered() || !this->mrmlScene() || this->mrmlScene()->IsBatchProcessing())
    return;
  m_sceneIsNew = false;
  const bool isNew = !this->mrmlScene()->GetSingletonNode("Settings", "vtkMRMLFenestraRenderNode");
  Node* settings = fenestraLogic()->GetSettings();
  if (const std::string size = isNew ? findViewSize(512.0) : ""; !size.empty())
    settings->SetFlag("size", size);
  m_settings->use(settings);
  if (!chosenRender())
    m_panel->renders->setCurrentNode(fenestraLogic()->GetShownRender());
}

void qSlicerFenestraModuleWidget::preview() {
  const bool shown = this->isEntered() && m_panel->showPreview->isChecked() && hasVolume();
  m_session->preview(shown ? m_settings->node() : nullptr);
}

bool qSlicerFenestraModuleWidget::hasVolume() const {
  return m_settings->node() && m_settings->node()->GetNodeReference(Node::VolumeRole);
}

// ---- renders

Node* qSlicerFenestraModuleWidget::chosenRender() const {
  return Node::SafeDownCast(m_panel->renders->currentNode());
}

void qSlicerFenestraModuleWidget::render() {
  start(qSlicerFenestraSession::Kind::picture);
}

void qSlicerFenestraModuleWidget::renderTurntable() {
  start(qSlicerFenestraSession::Kind::turntable);
}

void qSlicerFenestraModuleWidget::start(qSlicerFenestraSession::Kind kind) {
  if (!m_settings->node())
    return;
  clearStatus();
  m_session->render(m_settings->node(), kind);
  updateButtons();
}

/// Shows the result twice: a view that the layout just created fits the image only once the view
/// has its size.
void qSlicerFenestraModuleWidget::showResult(Node* render, int times) {
  const vtkWeakPointer<Node> shown = render;
  QTimer::singleShot(0, this, [this, shown, times] {
    if (!shown || !shown->GetScene())
      return;
    fenestraLogic()->ShowResult(shown);
    if (shown == chosenRender() && shown->IsTurntable())
      fenestraLogic()->ShowFrame(shown, m_panel->player->frame());
    if (times > 1)
      showResult(shown, times - 1);
  });
}

/// Writing the results may take long; a second call ends the render without writing.
void qSlicerFenestraModuleWidget::stop() {
  m_session->stop();
  if (m_session->isRendering())
    setStatus(tr("Stopping: writing the finished samples. Press Stop again to discard them."));
}

void qSlicerFenestraModuleWidget::repeat() {
  Node* render = chosenRender();
  if (!render || !m_settings->node())
    return;
  m_settings->copy(render);
  if (render->WithholdsFiles())
    return setStatus(
        tr("This image needs files that are named in the scene. Allow them above, then "
           "press Render."));
  start(render->IsTurntable() ? qSlicerFenestraSession::Kind::turntable
                              : qSlicerFenestraSession::Kind::picture);
}

void qSlicerFenestraModuleWidget::showPreviewImage(const QImage& image,
                                                   const qFenestraPreviewImage& info) {
  m_panel->preview->setPixmap(QPixmap::fromImage(image));
  const QString noise = info.noise < 0.0 ? QString() : tr(", noise %1").arg(info.noise, 0, 'g', 2);
  m_panel->previewState->setText(
      tr("Preview: %1 samples per pixel%2, %3")
          .arg(info.samples)
          .arg(noise, qSlicerFenestraMeasures::formatDuration(info.seconds)));
}

/// Updates at most once per `interval`: Slicer's window redraws slowly without a GPU.
void qSlicerFenestraModuleWidget::onProgress(double fraction, double seconds) {
  constexpr int interval = 500; // milliseconds
  if (m_session->isStopping() || (m_progressAge.isValid() && m_progressAge.elapsed() < interval))
    return;
  m_progressAge.start();
  m_panel->progress->show();
  m_panel->progress->setValue(static_cast<int>(1000.0 * fraction));
  QString line = tr("%1 elapsed").arg(qSlicerFenestraMeasures::formatDuration(seconds));
  if (fraction > 0.01)
    line +=
        tr(", %1 left")
            .arg(qSlicerFenestraMeasures::formatDuration(seconds * (1.0 - fraction) / fraction));
  if (!m_samplesAndNoise.isEmpty())
    line += ", " + m_samplesAndNoise;
  if (m_session->waitingCount() > 0)
    line += tr("; %n more in the queue", nullptr, m_session->waitingCount());
  setStatus(line);
}

QString qSlicerFenestraModuleWidget::toUserText(Node* render, qFenestraOutcome::Kind kind) const {
  using Kind = qFenestraOutcome::Kind;
  const bool isComplete = kind == Kind::done;
  if (!render)
    return kind == Kind::killed ? tr("Stopped immediately, without an image.")
                                : tr("Stopped before there was an image.");
  const QString description = QString::fromUtf8(render->GetDescription());
  if (description.isEmpty()) // the renderer wrote no statistics
    return isComplete ? tr("Done.") : tr("Stopped.");
  return (isComplete ? tr("Done: %1.") : tr("Stopped: %1.")).arg(description);
}

void qSlicerFenestraModuleWidget::onEnded(Node* render, const qFenestraOutcome& outcome) {
  m_panel->progress->hide();
  if (outcome.kind == qFenestraOutcome::Kind::failed)
    setStatus(outcome.message, outcome.details);
  else
    setStatus(toUserText(render, outcome.kind));
  if (render) {
    const QSignalBlocker blocker(m_panel->renders); // shown below
    m_panel->renders->setCurrentNode(render);
  }
  showSelected();
  showResult(render);
}

void qSlicerFenestraModuleWidget::setStatus(const QString& message, const QString& details) {
  m_panel->state->setText(message);
  m_panel->detailsText->setText(details);
  m_panel->details->setVisible(!details.isEmpty());
  m_panel->details->setChecked(false);
}

/// Clears the last render's message after another user action.
void qSlicerFenestraModuleWidget::clearStatus() {
  if (!m_session->isRendering())
    setStatus({});
}

void qSlicerFenestraModuleWidget::updateButtons() {
  const bool hasVolume = this->hasVolume();
  m_panel->render->setEnabled(hasVolume);
  m_panel->turn->setEnabled(hasVolume);
  m_panel->sample->setVisible(!hasVolume);
  if (!hasVolume) {
    m_panel->preview->setText(tr("Load a volume, or the sample knee"));
    m_panel->previewState->clear();
  }
  m_panel->stop->setEnabled(m_session->isRendering());
  Node* render = chosenRender();
  const bool hasImage = render && render->GetNodeReference(Node::PictureRole);
  m_panel->show->setEnabled(hasImage);
  m_panel->save->setEnabled(hasImage);
  m_panel->back->setEnabled(fenestraLogic()->GetShownRender() != nullptr);
  m_panel->repeat->setEnabled(render != nullptr);
  m_panel->resume->setVisible(m_session->canResume(render));
}

/// Replaces the displayed image, if any, by the chosen one.
void qSlicerFenestraModuleWidget::onRenderChosen() {
  showSelected();
  if (chosenRender() && fenestraLogic()->GetShownRender())
    showResult(chosenRender());
}

/// Shows description, player and measures of the chosen image.
void qSlicerFenestraModuleWidget::showSelected() {
  updateButtons();
  Node* render = chosenRender();
  const char* description = render ? render->GetDescription() : nullptr;
  m_panel->description->setText(QString::fromUtf8(description ? description : ""));
  const int frames =
      render && render->IsTurntable() ? fenestraLogic()->GetNumberOfFrames(render) : 0;
  m_panel->player->setVisible(frames > 0);
  m_panel->player->setFrames(frames);
  showMeasures(render);
}

void qSlicerFenestraModuleWidget::showMeasures(Node* render) {
  const char* text = render ? render->GetAttribute(Node::MeasuresAttribute) : nullptr;
  const auto measures =
      qSlicerFenestraMeasures::toUserText(QJsonDocument::fromJson(text ? text : "").object());
  QString rows, help;
  for (const qSlicerFenestraMeasures::Measure& one : measures) {
    rows += QString("<tr><td>%1:&nbsp;</td><td>%2</td></tr>").arg(one.name, one.value);
    help += QString("<p><b>%1</b>: %2</p>").arg(one.name, one.help);
  }
  m_panel->measures->setText(rows.isEmpty() ? rows : "<table>" + rows + "</table>");
  m_panel->measures->setToolTip(help);
  m_panel->measures->setVisible(!rows.isEmpty());
}

// ---- files

void qSlicerFenestraModuleWidget::save() {
  Node* render = chosenRender();
  const bool isTurntable = render->IsTurntable();
  const QStringList frames = m_session->results().findFrames(render);
  if (isTurntable ? frames.isEmpty() : m_session->results().findFile(render, "png").isEmpty())
    return setStatus(
        tr("The files of this image were removed with the session that rendered it. Press "
           "Repeat, then save."));
  const QString png = isTurntable ? tr("Numbered images (*.png)") : tr("Image (*.png)");
  const QString exr = tr("Linear color and depth (*.exr)");
  // Overwriting is confirmed below for the final names, which may gain an extension or a number.
  const QString chosen = QFileDialog::getSaveFileName(
      this, isTurntable ? tr("Save numbered frames") : tr("Save image"),
      QString::fromUtf8(render->GetName()) + ".png", isTurntable ? png : png + ";;" + exr, nullptr,
      QFileDialog::DontConfirmOverwrite);
  if (chosen.isEmpty())
    return;
  const QString ending = chosen.endsWith(".exr", Qt::CaseInsensitive) ? "exr" : "png";
  const QString picture = m_session->results().findFile(render, ending);
  saveAs(isTurntable ? qFenestraCopies::frames(frames, chosen)
                     : qFenestraCopies::picture(picture, chosen, "." + ending));
}

void qSlicerFenestraModuleWidget::saveAs(const qFenestraCopies& copies) {
  const QStringList replaced = copies.existingTargets();
  const QString question = replaced.size() == 1
                               ? tr("%1 already exists. Replace it?").arg(replaced.first())
                               : tr("%n files already exist, the first is %1. Replace them?",
                                    nullptr, static_cast<int>(replaced.size()))
                                     .arg(replaced.value(0));
  if (!replaced.isEmpty() && QMessageBox::question(this, tr("Save"), question) != QMessageBox::Yes)
    return;
  const QString failed = copies.write();
  setStatus(
      failed.isEmpty()
          ? tr("Saved as %1.").arg(copies.names())
          : tr("%1 could not be written and is unchanged. Choose another folder.").arg(failed));
}

void qSlicerFenestraModuleWidget::loadSample() {
  m_session->makeSample([this](const QString& scene, const QString& message) {
    if (scene.isEmpty())
      return setStatus(tr("The sample could not be generated."), message);
    qSlicerIO::IOProperties properties;
    properties["fileName"] = scene;
    properties["clear"] = false;
    qSlicerCoreApplication::application()->coreIOManager()->loadNodes("SceneFile", properties);
    fenestraLogic()->ShowNewestVolume();
    setStatus(tr("The synthetic knee is loaded. Choose a segment as focus."));
  });
}
