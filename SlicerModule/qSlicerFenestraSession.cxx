#include "qSlicerFenestraSession.h"

#include "FenestraMaterials.h"

#include <qSlicerCoreApplication.h>

#include <QDebug>
#include <QDir>
#include <QFile>
#include <QFileInfo>

#include <vtkImageData.h>
#include <vtkMRMLScene.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

namespace {

using Node = vtkMRMLFenestraRenderNode;
using Ended = qFenestraOutcome::Kind;

qFenestraOutcome toFailure(const QString& message, const QString& details = {}) {
  return {Ended::failed, message, details};
}

/// Another program than the renderer.
QString noImageText() {
  return qSlicerFenestraSession::tr(
      "The renderer ended without an image. Check the executable in the application settings.");
}

} // namespace

qSlicerFenestraSession::qSlicerFenestraSession(vtkSlicerFenestraLogic* logic,
                                               const QString& program, QObject* parent)
    : QObject(parent),
      m_logic(logic),
      m_installedProgram(program),
      m_files(std::make_shared<Files>()),
      m_queue(program) {
  m_worker.setMaxThreadCount(1);
  constexpr int interval = 60; // ms; merges the changes of a mouse drag
  m_refreshTimer.setSingleShot(true);
  m_refreshTimer.setInterval(interval);
  qvtkConnect(m_logic, vtkSlicerFenestraLogic::RenderRequestedEvent, this,
              SLOT(onRenderRequested(vtkObject*, vtkObject*)));
  qvtkConnect(m_logic, vtkSlicerFenestraLogic::RenderWaitEvent, this,
              SLOT(onRenderWait(vtkObject*, vtkObject*)));
  qvtkConnect(m_logic, vtkSlicerFenestraLogic::StopRequestedEvent, this, SLOT(stop()));
  qvtkConnect(m_logic, vtkSlicerFenestraLogic::ViewChangedEvent, this, SLOT(onViewChanged()));
  qvtkConnect(m_logic, vtkSlicerFenestraLogic::OpeningChangedEvent, this, SLOT(onOpeningChanged()));
  qvtkConnect(m_logic, vtkSlicerFenestraLogic::OpeningWaitEvent, this, SLOT(onOpeningWait()));
  qvtkConnect(m_logic, vtkSlicerFenestraLogic::SampleRequestedEvent, this,
              SLOT(onSampleRequested()));
  m_openingTimer.setSingleShot(true);
  m_openingTimer.setInterval(interval);
  connect(&m_openingTimer, &QTimer::timeout, this, &qSlicerFenestraSession::updateOpening);
  constexpr int sampleInterval = 500; // ms
  m_sampleTimer.setInterval(sampleInterval);
  connect(&m_sampleTimer, &QTimer::timeout, this,
          [this] { emit sampleProgressed(static_cast<double>(m_sampleTime.elapsed()) / 1000.0); });
  connect(&m_refreshTimer, &QTimer::timeout, this, &qSlicerFenestraSession::updatePreview);
  connect(&m_preview, &qFenestraPreview::refreshed, this, &qSlicerFenestraSession::showPreview);
  connect(&m_preview, &qFenestraPreview::refused, this, [this](const QString& message) {
    for (auto flag = m_sentFlags.begin(); flag != m_sentFlags.end(); ++flag)
      flag.value() = QJsonValue::Null; // the renderer took none of them: the next change has all
    emit previewRefused(toUserText(message, m_files->folder.path()));
  });
  connect(&m_preview, &qFenestraPreview::ended, this, [this](const qFenestraOutcome& outcome) {
    // Without a failure, too: only another program than the renderer ends by itself.
    emit previewRefused(outcome.kind == Ended::failed
                            ? toUserText(outcome.message, m_files->folder.path())
                            : noImageText());
  });
  connect(&m_queue, &qFenestraQueue::started, this, [this](int id) {
    m_renderTime.start();
    if (Node* node = m_renders[id].node)
      node->SetRenderState(Node::Running);
    emit started(m_renders[id].node);
  });
  connect(&m_queue, &qFenestraQueue::progressed, this, [this](int id, double fraction) {
    if (Node* node = m_renders[id].node)
      node->SetProgress(fraction);
    emit progressed(m_renders[id].node, fraction,
                    static_cast<double>(m_renderTime.elapsed()) / 1000.0);
  });
  connect(&m_queue, &qFenestraQueue::commented, this,
          [this](int, const QString& text) { emit statusChanged(text); });
  connect(&m_queue, &qFenestraQueue::ended, this, &qSlicerFenestraSession::finishRender);
  connect(&m_materials, &qFenestraMaterialsQuery::received, this,
          &qSlicerFenestraSession::materialsReceived);
  connect(this, &qSlicerFenestraSession::ended, this, [](Node*, const qFenestraOutcome& outcome) {
    if (outcome.kind == Ended::failed)
      qCritical().noquote() << "Fenestra:" << outcome.message << outcome.details;
  });
  connect(this, &qSlicerFenestraSession::previewRefused, this,
          [](const QString& message) { qInfo().noquote() << "Fenestra: no preview:" << message; });
}

qSlicerFenestraSession::~qSlicerFenestraSession() {
  disconnect(&m_queue, nullptr, this, nullptr);
  disconnect(&m_preview, nullptr, this, nullptr);
  disconnect(&m_materials, nullptr, this, nullptr);
  m_preview.stop();
  m_worker.clear();
  m_worker.waitForDone();
}

QString qSlicerFenestraSession::program() const {
  return qSlicerFenestraApplicationSettings::findProgram(m_installedProgram);
}

void qSlicerFenestraSession::renewFiles() {
  m_earlierFiles << m_files;
  m_files = std::make_shared<Files>();
  m_preview.stop();
  refresh();
}

void qSlicerFenestraSession::removeFolder(const QString& folder) {
  if (!folder.isEmpty())
    QDir(folder).removeRecursively();
}

void qSlicerFenestraSession::queryMaterials(const std::vector<SlicerExport::Segment>& segments) {
  if (segments == m_queriedSegments)
    return;
  m_queriedSegments = segments;
  if (!segments.empty())
    m_materials.request(program(), segments, m_files->folder.path());
}

void qSlicerFenestraSession::runInWorker(const std::function<void()>& job) {
  m_worker.start(QRunnable::create(job));
}

/// Runs the job in the main thread, unless this object is deleted before.
void qSlicerFenestraSession::runInMainThread(const std::function<void()>& job) {
  QMetaObject::invokeMethod(this, job, Qt::QueuedConnection);
}

void qSlicerFenestraSession::write(
    const SlicerExport::Contents& contents,
    const std::function<void(const QString& scene, const QString& failure)>& then) {
  const auto shared = std::make_shared<SlicerExport::Contents>(contents);
  runInWorker([this, shared, files = m_files, then] {
    QString scene, message;
    try {
      scene = QString::fromStdString(files->writer.write(*shared).string());
    } catch (const std::exception& error) {
      message = QString::fromUtf8(error.what());
    }
    runInMainThread([scene, message, then] { then(scene, message); });
  });
}

QString qSlicerFenestraSession::toUserText(QString message, const QString& folder) {
  const int colon = message.indexOf(": ");
  if (colon > 0 && message.startsWith(folder))
    message.remove(0, colon + 2);
  if (!message.isEmpty())
    message[0] = message[0].toUpper();
  return message;
}

// ---- renders

vtkMRMLFenestraRenderNode* qSlicerFenestraSession::render(Node* settings, Kind kind) {
  return kind == Kind::turntable ? m_logic->RenderTurntable(settings) : m_logic->Render(settings);
}

void qSlicerFenestraSession::onRenderRequested(vtkObject*, vtkObject* render) {
  Node* node = Node::SafeDownCast(render);
  const int id = ++m_lastId;
  m_renders[id] = {node, m_files, {}};
  node->SetRenderState(Node::Queued);
  SlicerExport::Contents contents;
  try {
    if (!QFileInfo(program()).isExecutable())
      throw SlicerExport::UserError("The renderer is missing. Install the Fenestra extension "
                                    "again, or check the executable in the application settings.");
    contents = m_logic->Snapshot(node, m_files->folder.path().toStdString());
  } catch (const SlicerExport::UserError& error) {
    return endRender(id, toFailure(QString::fromUtf8(error.what()), program()));
  }
  m_preview.stop();
  node->SetFlags(
      SlicerExport::filterMaterialFlags(contents.segmentation.segments, node->GetFlags()));
  const bool withSurface =
      vtkSlicerFenestraLogic::HasSurface(node) && !contents.segmentation.segments.empty();
  submit(id, contents, withSurface);
}

/// Writes the scene and queues the render. The voxels are shared with Slicer: an edit during the
/// writing corrupts the files, which are then written again, at most `tries` times.
void qSlicerFenestraSession::submit(int id, const SlicerExport::Contents& contents,
                                    bool withSurface, int tries) {
  write(contents, [=](const QString& scene, const QString& message) {
    Render& render = m_renders[id];
    if (!message.isEmpty())
      return endRender(id, toFailure(tr("The volume could not be written for the renderer. %1.")
                                         .arg(toUserText(message, render.files->folder.path()))));
    render.folder = QFileInfo(scene).absolutePath();
    if (render.stopped || !render.node)
      return endRender(id, {Ended::stopped, {}, {}});
    try {
      const SlicerExport::Contents now =
          m_logic->Snapshot(render.node, m_files->folder.path().toStdString());
      const bool isUnchanged =
          now.volumeKey == contents.volumeKey && now.segmentationKey == contents.segmentationKey;
      if (!isUnchanged && tries > 0)
        return submit(id, now, withSurface, tries - 1);
    } catch (const SlicerExport::UserError& error) {
      return endRender(id, toFailure(QString::fromUtf8(error.what())));
    }
    m_queue.setProgram(program());
    m_queue.add({id, makeArguments(render.node, scene, withSurface), render.folder});
  });
}

/// Waits until the view has changed completely.
void qSlicerFenestraSession::onViewChanged() {
  runInMainThread([this] { m_logic->AlignView(); });
}

/// Passes all flags on the command line, which the renderer trusts more than a scene.
QStringList qSlicerFenestraSession::makeArguments(Node* render, const QString& scene,
                                                  bool withSurface) const {
  QStringList all = render->IsTurntable() ? QStringList{"turntable", scene} : QStringList{scene};
  for (const std::string& argument : vtkSlicerFenestraLogic::GetArguments(render, withSurface))
    all << QString::fromStdString(argument);
  return all + qSlicerFenestraApplicationSettings::makeDeviceArguments() +
         qSlicerFenestraApplicationSettings::makeThreadArguments();
}

bool qSlicerFenestraSession::canResume(Node* turntable) const {
  return m_results.lacksFrames(turntable) && !turntable->IsRendering();
}

void qSlicerFenestraSession::resume(Node* turntable) {
  if (!canResume(turntable))
    return;
  m_preview.stop();
  const int id = ++m_lastId;
  turntable->SetRenderState(Node::Queued);
  const QString folder = m_results.findFolder(turntable);
  m_renders[id] = {turntable, m_files, folder};
  m_queue.setProgram(program());
  m_queue.add({id, makeArguments(turntable, folder + "/scene.mrml", false), folder});
}

void qSlicerFenestraSession::stop() {
  if (!m_renders.isEmpty()) {
    m_renders.first().stopped = true;
    m_queue.stop(m_renders.firstKey());
  }
}

void qSlicerFenestraSession::closeScene() {
  m_preview.stop();
  m_results.clear();
  const QList<int> ids = m_renders.keys(); // a copy: waiting renders end in stop()
  for (const int id : ids) {
    m_renders[id].stopped = true;
    m_queue.stop(id);
    m_queue.stop(id); // discards the results of the current render
  }
  m_files = std::make_shared<Files>(); // the old files are removed with their last process
  m_earlierFiles.clear();
  m_previewKey.clear();
  m_previewFolder.clear();
  m_focusKey.clear();
  if (m_focusProgram)
    m_focusProgram->stop();
}

void qSlicerFenestraSession::finishRender(int id, const qFenestraOutcome& outcome) {
  const QString folder = m_renders[id].folder;
  emit renderStopped();
  Node* node = m_renders[id].node;
  const bool isTurntable =
      node && node->IsTurntable(); // keeps finished frames even after a failure
  const bool hasFiles =
      isTurntable ? !vtkSlicerFenestraLogic::GetFrameFiles(folder.toStdString()).empty()
                  : outcome.kind != Ended::failed && QFileInfo::exists(folder + "/radiance.nrrd");
  if (!hasFiles)
    return endRender(id, outcome.kind == Ended::done ? toFailure(noImageText()) : outcome);
  runInWorker([this, id, outcome, folder] {
    const auto result = std::make_shared<FenestraResult>();
    QString message;
    try {
      *result = vtkSlicerFenestraLogic::ReadResult(folder.toStdString());
    } catch (const std::exception& error) {
      message = QString::fromUtf8(error.what());
    }
    runInMainThread([this, id, outcome, result, message] {
      if (!message.isEmpty())
        return endRender(id, toFailure(tr("The image could not be read. Press Repeat."), message));
      const auto paused = std::make_shared<SlicerRenderBlocker>(); // draws the views once
      addResult(id, outcome, [this, result, paused](Node* node, int step) {
        m_logic->AddResult(node, *result, step);
      });
    });
  });
}

/// Adds one step, then returns to the event loop, where the user may close the scene.
void qSlicerFenestraSession::addResult(int id, const qFenestraOutcome& outcome,
                                       const std::function<void(Node*, int)>& add, int step) {
  Node* node = m_renders[id].node;
  const bool open = node && node->GetScene();
  if (open && step < vtkSlicerFenestraLogic::ResultSteps) {
    add(node, step);
    return runInMainThread(
        [this, id, outcome, add, step] { addResult(id, outcome, add, step + 1); });
  }
  if (open)
    m_results.add(node, m_renders[id].folder);
  endRender(id, outcome);
}

void qSlicerFenestraSession::endRender(int id, const qFenestraOutcome& outcome) {
  const Render render = m_renders.take(id);
  vtkSmartPointer<Node> node = render.node.GetPointer();
  const bool hasResult = node && node->GetScene() && node->GetNodeReference(Node::PictureRole);
  if (!hasResult || !m_results.lacksFrames(node)) // resuming needs these files
    for (const char* file : {"scene.mrml", "volume.nrrd", "segmentation.seg.nrrd", "roi.mrk.json"})
      if (!render.folder.isEmpty())
        QFile::remove(render.folder + "/" + file);
  if (!hasResult)
    removeFolder(render.folder);
  const QString message = toUserText(outcome.message, render.files->folder.path());
  const QString problem =
      outcome.kind == Ended::failed ? message : tr("Stopped before there was an image.");
  if (node)
    node->EndRender(hasResult ? std::string() : problem.toStdString());
  if (node && !hasResult && node->GetScene())
    node->GetScene()->RemoveNode(node);
  emit ended(hasResult ? node.GetPointer() : nullptr, {outcome.kind, message, outcome.details});
  if (!isRendering())
    refresh();
}
