#include "qSlicerFenestraModuleWidget.h"

#include "qSlicerFenestra3DViews.h"
#include "qSlicerFenestraMeasures.h"
#include "qSlicerFenestraModule.h"
#include "qSlicerFenestraSaving.h"
#include "qSlicerFenestraWidgets.h"
#include "ui_qSlicerFenestraModuleWidget.h"
#include "vtkMRMLFenestraRenderNode.h"
#include "vtkSlicerFenestraLogic.h"

#include <qMRMLThreeDView.h>
#include <qMRMLThreeDWidget.h>

#include <vtkCommand.h>
#include <vtkMRMLScene.h>
#include <vtkRenderWindow.h>

#include <QJsonDocument>
#include <QPointer>
#include <QSignalBlocker>
#include <QTimer>

#include <cmath>

namespace {

using Node = vtkMRMLFenestraRenderNode;
using qSlicerFenestraMeasures::formatDuration;

} // namespace

class qSlicerFenestraModuleWidgetPrivate : public Ui_qSlicerFenestraModuleWidget {
  Q_DECLARE_TR_FUNCTIONS(qSlicerFenestraModuleWidget)

public:
  Node* chosenRender() const { return Node::SafeDownCast(RendersBox->currentNode()); }
  bool hasVolume() const;
  void setStatus(const QString& message, const QString& details = {});
  void clearStatus();
  void setLoading(bool loading);
  void showPreviewImage(const QImage& image, const qFenestraPreviewImage& info);
  void showMeasures(Node* render);
  QString toUserText(Node* render, qFenestraOutcome::Kind kind) const;

  QPointer<qSlicerFenestraSession> session; ///< owned by the module, which may end earlier
  vtkWeakPointer<vtkRenderWindow> window;   ///< of the 3D view whose size is followed
  bool sceneIsNew = false;                  ///< scene closed or loaded, but not shown yet
  bool isLoading = false;                   ///< generating the sample
  QString samplesAndNoise;                  ///< samples and noise of the current render, as text
  QElapsedTimer progressAge;                ///< time since progress was last shown
};

qSlicerFenestraModuleWidget::qSlicerFenestraModuleWidget(QWidget* parent)
    : Superclass(parent), d_ptr(new qSlicerFenestraModuleWidgetPrivate) {}

qSlicerFenestraModuleWidget::~qSlicerFenestraModuleWidget() {
  Q_D(qSlicerFenestraModuleWidget);
  if (d->session) { // the module owns it and keeps it running
    d->session->preview(nullptr);
    d->session->disconnect(this);
  }
}

qSlicerFenestraSession* qSlicerFenestraModuleWidget::session() const {
  Q_D(const qSlicerFenestraModuleWidget);
  return d->session;
}

vtkSlicerFenestraLogic* qSlicerFenestraModuleWidget::fenestraLogic() const {
  return vtkSlicerFenestraLogic::SafeDownCast(this->logic());
}

void qSlicerFenestraModuleWidget::setup() {
  Q_D(qSlicerFenestraModuleWidget);
  d->setupUi(this);
  qSlicerFenestraWidgets::nameParts(this);
  Superclass::setup();
  d->Settings->setLogic(fenestraLogic());
  d->Opening->setLogic(fenestraLogic());
  d->session = dynamic_cast<qSlicerFenestraModule*>(this->module())->session();
  connectPanel();
  connectSession();
  updateButtons();
}

void qSlicerFenestraModuleWidget::connectPanel() {
  using Widget = qSlicerFenestraModuleWidget;
  Q_D(qSlicerFenestraModuleWidget);
  connect(d->RendersBox, SIGNAL(currentNodeChanged(vtkMRMLNode*)), this, SLOT(onRenderChosen()));
  connect(d->PreviewBox, &QCheckBox::toggled, this, &Widget::preview);
  connect(d->RenderButton, &QPushButton::clicked, this, &Widget::render);
  connect(d->ResumeButton, &QPushButton::clicked, this, [this, d] {
    d->session->resume(d->chosenRender());
    updateButtons();
  });
  connect(d->Player, &qSlicerFenestraPlayer::frameChanged, this, [this, d](int frame) {
    if (d->chosenRender())
      fenestraLogic()->ShowFrame(d->chosenRender(), frame);
  });
  connect(d->StopButton, &QPushButton::clicked, this, &Widget::stop);
  connect(d->RepeatButton, &QPushButton::clicked, this, &Widget::repeat);
  connect(d->ShowButton, &QPushButton::clicked, this, [this, d] {
    d->clearStatus();
    showResult(d->chosenRender());
  });
  connect(d->BackButton, &QPushButton::clicked, this, [this] {
    fenestraLogic()->ShowLayoutBefore();
    updateButtons();
  });
  connect(d->SaveButton, &QPushButton::clicked, this, &Widget::save);
  connect(d->Settings, &qSlicerFenestraSettings::sampleRequested, this, &Widget::loadSample);
  connect(d->Settings, &qSlicerFenestraSettings::turntableRequested, this,
          &Widget::renderTurntable);
  connect(d->Settings, &qSlicerFenestraSettings::changed, this, [this, d] {
    followView();
    d->session->queryMaterials(vtkSlicerFenestraLogic::GetSegments(d->Settings->node()));
    updateButtons();
    preview();
  });
}

void qSlicerFenestraModuleWidget::connectSession() {
  using Session = qSlicerFenestraSession;
  Q_D(qSlicerFenestraModuleWidget);
  connect(d->session, &Session::materialsReceived, d->Settings,
          &qSlicerFenestraSettings::setKnownMaterials);
  connect(d->session, &Session::previewReceived, this,
          [d](const QImage& image, const qFenestraPreviewImage& info) {
            d->showPreviewImage(image, info);
          });
  connect(d->session, &Session::previewRefused, d->PreviewStateLabel, &QLabel::setText);
  connect(d->session, &Session::started, this, [this, d](Node*) {
    d->samplesAndNoise.clear();
    d->progressAge.invalidate();
    d->setStatus(tr("Rendering..."));
    updateButtons();
  });
  connect(d->session, &Session::statusChanged, this,
          [d](const QString& text) { d->samplesAndNoise = text; });
  connect(d->session, &Session::progressed, this,
          [this](Node*, double fraction, double seconds) { onProgress(fraction, seconds); });
  connect(d->session, &Session::sampleProgressed, this, [d](double seconds) {
    if (d->isLoading) // else a script's
      d->setStatus(tr("Generating the synthetic knee: %1").arg(formatDuration(seconds)));
  });
  connect(d->session, &Session::ended, this, &qSlicerFenestraModuleWidget::onEnded);
}

// ---- the scene

void qSlicerFenestraModuleWidget::setMRMLScene(vtkMRMLScene* scene) {
  vtkMRMLScene* const before = this->mrmlScene();
  this->qvtkReconnect(before, scene, vtkMRMLScene::EndCloseEvent, this, SLOT(onSceneClosed()));
  this->qvtkReconnect(before, scene, vtkMRMLScene::EndImportEvent, this, SLOT(onSceneImported()));
  this->qvtkReconnect(before, scene, vtkMRMLScene::EndBatchProcessEvent, this, SLOT(useNewScene()));
  Superclass::setMRMLScene(scene);
  useScene();
}

void qSlicerFenestraModuleWidget::enter() {
  Superclass::enter();
  useScene();
}

void qSlicerFenestraModuleWidget::exit() {
  Q_D(qSlicerFenestraModuleWidget);
  d->session->preview(nullptr);
  Superclass::exit();
}

/// Clears messages about the scene; the module closes the session's scene.
void qSlicerFenestraModuleWidget::onSceneClosed() {
  Q_D(qSlicerFenestraModuleWidget);
  d->sceneIsNew = true;
  d->clearStatus();
}

void qSlicerFenestraModuleWidget::onSceneImported() {
  Q_D(qSlicerFenestraModuleWidget);
  d->sceneIsNew = true;
}

/// Called at the end of a batch: earlier, the panel's boxes lack the nodes, and opening a scene
/// closes the old one in the same batch.
void qSlicerFenestraModuleWidget::useNewScene() {
  Q_D(qSlicerFenestraModuleWidget);
  if (d->sceneIsNew)
    useScene();
}

void qSlicerFenestraModuleWidget::useScene() {
  Q_D(qSlicerFenestraModuleWidget);
  if (!this->isEntered() || !this->mrmlScene() || this->mrmlScene()->IsBatchProcessing())
    return;
  d->sceneIsNew = false;
  d->Settings->use(fenestraLogic()->GetSettings());
  if (!d->chosenRender())
    d->RendersBox->setCurrentNode(fenestraLogic()->GetShownRender());
}

/// Takes the size of the 3D view now, and whenever it changes.
void qSlicerFenestraModuleWidget::followView() {
  Q_D(qSlicerFenestraModuleWidget);
  Node* settings = d->Settings->node();
  const qMRMLThreeDWidget* view =
      settings ? qSlicerFenestra3DViews::findWidget(settings->GetNodeReference(Node::ViewRole))
               : nullptr;
  vtkRenderWindow* window = view ? view->threeDView()->renderWindow() : nullptr;
  if (window != d->window)
    this->qvtkReconnect(d->window, window, vtkCommand::WindowResizeEvent, d->Settings,
                        SLOT(followViewSize()));
  d->window = window;
  d->Settings->followViewSize();
}

void qSlicerFenestraModuleWidget::preview() {
  Q_D(qSlicerFenestraModuleWidget);
  const bool shown = this->isEntered() && d->PreviewBox->isChecked() && d->hasVolume();
  d->session->preview(shown ? d->Settings->node() : nullptr);
}

bool qSlicerFenestraModuleWidgetPrivate::hasVolume() const {
  return Settings->node() && Settings->node()->GetNodeReference(Node::VolumeRole);
}

// ---- renders

void qSlicerFenestraModuleWidget::render() {
  start(qSlicerFenestraSession::Kind::picture);
}

void qSlicerFenestraModuleWidget::renderTurntable() {
  start(qSlicerFenestraSession::Kind::turntable);
}

void qSlicerFenestraModuleWidget::start(qSlicerFenestraSession::Kind kind) {
  Q_D(qSlicerFenestraModuleWidget);
  if (!d->Settings->node())
    return;
  d->clearStatus();
  d->Settings->followViewSize();
  d->session->render(d->Settings->node(), kind);
  updateButtons();
}

/// Shows the result after the current event, which may still change the layout.
void qSlicerFenestraModuleWidget::showResult(Node* render) {
  Q_D(qSlicerFenestraModuleWidget);
  const vtkWeakPointer<Node> shown = render;
  QTimer::singleShot(0, this, [this, d, shown] {
    if (!shown || !shown->GetScene())
      return;
    fenestraLogic()->ShowResult(shown);
    if (shown == d->chosenRender() && shown->IsTurntable())
      fenestraLogic()->ShowFrame(shown, d->Player->frame());
    updateButtons(); // Back
  });
}

/// Writing the results may take long; a second call ends the render without writing.
void qSlicerFenestraModuleWidget::stop() {
  Q_D(qSlicerFenestraModuleWidget);
  d->session->stop();
  if (d->session->isRendering())
    d->setStatus(tr("Stopping: writing the finished samples. Press Stop again to discard them."));
}

void qSlicerFenestraModuleWidget::repeat() {
  Q_D(qSlicerFenestraModuleWidget);
  Node* render = d->chosenRender();
  if (!render || !d->Settings->node())
    return;
  d->Settings->copy(render);
  if (render->WithholdsFiles())
    return d->setStatus(
        tr("This image needs files that are named in the scene. Allow them above, then "
           "press Render."));
  start(render->IsTurntable() ? qSlicerFenestraSession::Kind::turntable
                              : qSlicerFenestraSession::Kind::picture);
}

void qSlicerFenestraModuleWidgetPrivate::showPreviewImage(const QImage& image,
                                                          const qFenestraPreviewImage& info) {
  PreviewLabel->showImage(image);
  const double value = info.frame->noise;
  const QString noise = std::isnan(value) ? QString() : tr(", noise %1").arg(value, 0, 'g', 2);
  PreviewStateLabel->setText(tr("%1 samples per pixel%2, %3")
                                 .arg(info.frame->samples)
                                 .arg(noise, formatDuration(info.seconds)));
}

/// Updates at most once per `interval`: Slicer's window redraws slowly without a GPU.
void qSlicerFenestraModuleWidget::onProgress(double fraction, double seconds) {
  Q_D(qSlicerFenestraModuleWidget);
  constexpr int interval = 500; // milliseconds
  if (d->session->isStopping() || (d->progressAge.isValid() && d->progressAge.elapsed() < interval))
    return;
  d->progressAge.start();
  d->ProgressBar->show();
  d->ProgressBar->setValue(static_cast<int>(1000.0 * fraction));
  QString line = tr("%1 elapsed").arg(formatDuration(seconds));
  if (fraction > 0.01)
    line += tr(", %1 left").arg(formatDuration(seconds * (1.0 - fraction) / fraction));
  if (!d->samplesAndNoise.isEmpty())
    line += ", " + d->samplesAndNoise;
  if (d->session->waitingCount() > 0)
    line += tr("; %n more in the queue", nullptr, d->session->waitingCount());
  d->setStatus(line);
}

QString qSlicerFenestraModuleWidgetPrivate::toUserText(Node* render,
                                                       qFenestraOutcome::Kind kind) const {
  using Kind = qFenestraOutcome::Kind;
  const bool isComplete = kind == Kind::done;
  if (!render)
    return kind == Kind::killed ? tr("Stopped immediately, without an image.")
                                : tr("Stopped before there was an image.");
  const QString description = QString::fromUtf8(render->GetDescription());
  if (description.isEmpty()) // no statistics
    return isComplete ? tr("Done.") : tr("Stopped.");
  return (isComplete ? tr("Done: %1.") : tr("Stopped: %1.")).arg(description);
}

void qSlicerFenestraModuleWidget::onEnded(Node* render, const qFenestraOutcome& outcome) {
  Q_D(qSlicerFenestraModuleWidget);
  d->ProgressBar->hide();
  if (outcome.kind == qFenestraOutcome::Kind::failed)
    d->setStatus(outcome.message, outcome.details);
  else
    d->setStatus(d->toUserText(render, outcome.kind));
  if (render) {
    const QSignalBlocker blocker(d->RendersBox); // shown below
    d->RendersBox->setCurrentNode(render);
  }
  showSelected();
  showResult(render);
}

void qSlicerFenestraModuleWidgetPrivate::setStatus(const QString& message, const QString& details) {
  StateLabel->setText(message);
  DetailsLabel->setText(details);
  DetailsButton->setVisible(!details.isEmpty());
  DetailsButton->setChecked(false);
}

/// Clears the last render's message after another user action.
void qSlicerFenestraModuleWidgetPrivate::clearStatus() {
  if (!session->isRendering())
    setStatus({});
}

void qSlicerFenestraModuleWidget::updateButtons() {
  Q_D(qSlicerFenestraModuleWidget);
  using qSlicerFenestraWidgets::setEnabled;
  const bool hasVolume = d->hasVolume();
  setEnabled(d->RenderButton, hasVolume, tr("Choose a volume first"));
  d->Settings->setHasVolume(hasVolume);
  d->Opening->use(d->Settings->node());
  if (!hasVolume) {
    d->PreviewLabel->showText(tr("Load a volume, or the sample knee"));
    d->PreviewStateLabel->clear();
  } else if (!d->PreviewLabel->text().isEmpty()) {
    d->PreviewLabel->showText({});
  }
  setEnabled(d->StopButton, d->session->isRendering(), tr("No render is running"));
  Node* render = d->chosenRender();
  const bool hasImage = render && render->GetNodeReference(Node::PictureRole);
  const QString reason = tr("Render an image, or choose one above");
  setEnabled(d->ShowButton, hasImage, reason);
  setEnabled(d->SaveButton, hasImage, reason);
  setEnabled(d->RepeatButton, render != nullptr, reason);
  setEnabled(d->BackButton, fenestraLogic()->GetShownRender() != nullptr,
             tr("No image is shown beside the 3D view"));
  d->ResumeButton->setVisible(d->session->canResume(render));
}

/// Replaces the displayed image, if any, by the chosen one.
void qSlicerFenestraModuleWidget::onRenderChosen() {
  Q_D(qSlicerFenestraModuleWidget);
  showSelected();
  if (d->chosenRender() && fenestraLogic()->GetShownRender())
    showResult(d->chosenRender());
}

/// Shows description, player and measures of the chosen image.
void qSlicerFenestraModuleWidget::showSelected() {
  Q_D(qSlicerFenestraModuleWidget);
  updateButtons();
  Node* render = d->chosenRender();
  const char* description = render ? render->GetDescription() : nullptr;
  d->DescriptionLabel->setText(QString::fromUtf8(description ? description : ""));
  const int frames =
      render && render->IsTurntable() ? fenestraLogic()->GetNumberOfFrames(render) : 0;
  if (render)
    d->Images->setCollapsed(false);
  d->Player->setVisible(frames > 0);
  d->Player->setFrames(frames);
  d->showMeasures(render);
}

void qSlicerFenestraModuleWidgetPrivate::showMeasures(Node* render) {
  const char* text = render ? render->GetAttribute(Node::MeasuresAttribute) : nullptr;
  const auto measures =
      qSlicerFenestraMeasures::toUserText(QJsonDocument::fromJson(text ? text : "").object());
  QString rows, help;
  for (const qSlicerFenestraMeasures::Measure& one : measures) {
    rows += QString("<tr><td>%1:&nbsp;</td><td>%2</td></tr>").arg(one.name, one.value);
    help += QString("<p><b>%1</b>: %2</p>").arg(one.name, one.help);
  }
  MeasuresLabel->setText(rows.isEmpty() ? rows : "<table>" + rows + "</table>");
  MeasuresLabel->setToolTip(help);
  MeasuresLabel->setVisible(!rows.isEmpty());
}

// ---- files

void qSlicerFenestraModuleWidget::save() {
  Q_D(qSlicerFenestraModuleWidget);
  const QString message =
      qSlicerFenestraSaving::save(d->chosenRender(), d->session->results(), this);
  if (!message.isEmpty())
    d->setStatus(message);
}

void qSlicerFenestraModuleWidget::loadSample() {
  Q_D(qSlicerFenestraModuleWidget);
  d->setLoading(true);
  const QPointer<qSlicerFenestraModuleWidget> self = this; // may end before the session
  const bool isStarted =
      d->session->makeSample([self, d](const QString& scene, const QString& message) {
        if (!self)
          return;
        d->setLoading(false);
        if (scene.isEmpty())
          return d->setStatus(tr("The sample could not be generated."), message);
        d->session->loadSample(scene);
        d->setStatus(tr("The synthetic knee is loaded. Choose a segment as focus."));
      });
  if (!isStarted)
    d->setLoading(false);
}

/// Shows that the sample is being generated, which reports no progress.
void qSlicerFenestraModuleWidgetPrivate::setLoading(bool loading) {
  isLoading = loading;
  Settings->setSampleEnabled(!isLoading);
  ProgressBar->setMaximum(isLoading ? 0 : 1000); // 0: busy
  ProgressBar->setVisible(isLoading);
}
