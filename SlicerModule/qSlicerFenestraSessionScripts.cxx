// What scripts wait for: the end of a render, the opened view, the sample.

#include "qSlicerFenestraSession.h"

#include <qSlicerCoreApplication.h>
#include <qSlicerCoreIOManager.h>

#include <QDebug>
#include <QEventLoop>
#include <QFile>
#include <QFileInfo>

namespace {
using Node = vtkMRMLFenestraRenderNode;
} // namespace

/// Processes events, except user input, until the render has ended.
void qSlicerFenestraSession::onRenderWait(vtkObject*, vtkObject* render) {
  QEventLoop loop;
  connect(this, &qSlicerFenestraSession::ended, &loop, [&loop, node = Node::SafeDownCast(render)] {
    if (!node->IsRendering())
      loop.quit();
  });
  connect(this, &QObject::destroyed, &loop, &QEventLoop::quit);
  loop.exec(QEventLoop::ExcludeUserInputEvents);
}

/// True while the opened view will still change: its focus is prepared, or its image is rendered.
bool qSlicerFenestraSession::isOpeningPending() const {
  const bool isFocusPending =
      m_opening->GetVisible() && m_opening->GetProblem().empty() && !m_opening->HasFocus();
  return m_openingTimer.isActive() || m_opening->GetPreparing() || isFocusPending ||
         (m_opening->GetPhotorealistic() && !m_opening->HasImage());
}

/// Processes events, except user input, until the opened view shows what it was asked for, or
/// cannot: the preview is refused, or no 3D view requests an image.
void qSlicerFenestraSession::onOpeningWait() {
  constexpr int interval = 20;       // ms
  constexpr qint64 patience = 10000; // ms, in which a 3D view requests its image
  QEventLoop loop;
  QElapsedTimer sinceRequest;
  sinceRequest.start();
  QTimer timer;
  connect(&timer, &QTimer::timeout, &loop, [this, &loop, &sinceRequest] {
    if (m_viewed || !m_opening || !m_opening->GetPhotorealistic())
      sinceRequest.start();
    if (!m_opening || !isOpeningPending() || sinceRequest.elapsed() > patience)
      loop.quit();
  });
  connect(this, &qSlicerFenestraSession::previewRefused, &loop, [this, &loop] {
    if (m_viewed)
      loop.quit();
  });
  connect(this, &QObject::destroyed, &loop, &QEventLoop::quit);
  timer.start(interval);
  loop.exec(QEventLoop::ExcludeUserInputEvents);
}

bool qSlicerFenestraSession::makeSample(
    const std::function<void(const QString& scene, const QString& failure)>& then) {
  if (m_sampleTimer.isActive())
    return false;
  if (!m_sample)
    m_sample = std::make_unique<qFenestraFolder>(
        qSlicerFenestraApplicationSettings::findTemporaryFolder(), folderPrefix);
  const QString folder = m_sample->filePath("knee");
  QFile::remove(folder + "/knee.mrml"); // of an earlier sample
  auto* child = new qFenestraProgram(this);
  connect(child, &qFenestraProgram::ended, this,
          [this, child, folder, then](const qFenestraOutcome& outcome) {
            child->deleteLater();
            m_sampleTimer.stop();
            const QString scene = folder + "/knee.mrml";
            if (outcome.kind == qFenestraOutcome::Kind::done && QFileInfo::exists(scene))
              return then(scene, {});
            qCritical().noquote() << "Fenestra: the sample could not be generated:"
                                  << outcome.message << outcome.details;
            then({}, outcome.message + '\n' + outcome.details);
          });
  // Coarser than the default, as a clinical scan is, so that it takes half as long.
  child->run(program(), {"phantom", "knee", "--size", "240x276x96", "--quiet", "--output", folder},
             m_sample->path());
  m_sampleTime.start();
  m_sampleTimer.start();
  emit sampleProgressed(0.0);
  return true;
}

void qSlicerFenestraSession::loadSample(const QString& scene) {
  qSlicerIO::IOProperties properties;
  properties["fileName"] = scene;
  properties["clear"] = false;
  qSlicerCoreApplication::application()->coreIOManager()->loadNodes("SceneFile", properties);
  m_logic->ShowNewestVolume();
}

/// Processes events, except user input, until the sample is loaded.
void qSlicerFenestraSession::onSampleRequested() {
  QEventLoop loop;
  connect(this, &QObject::destroyed, &loop, &QEventLoop::quit);
  const bool isStarted = makeSample([this, &loop](const QString& scene, const QString&) {
    if (!scene.isEmpty())
      loadSample(scene);
    loop.quit();
  });
  if (isStarted)
    loop.exec(QEventLoop::ExcludeUserInputEvents);
  else
    qCritical("Fenestra: the sample is already being generated");
}
