#include "qSlicerFenestraLiveView.h"

#include "qSlicerFenestra3DViews.h"
#include "qSlicerFenestraSession.h"

#include <qMRMLThreeDView.h>
#include <qMRMLThreeDWidget.h>

#include <vtkMRMLCameraNode.h>
#include <vtkMRMLDisplayableNode.h>
#include <vtkMRMLViewNode.h>

#include <vtkCommand.h>
#include <vtkRenderer.h>
#include <vtkRendererCollection.h>

#include <algorithm>
#include <cmath>

namespace {

using Node = vtkMRMLFenestraRenderNode;
using SlicerExport::LiveState;

/// The camera that an image shows.
FenestraViewCamera toCamera(const SlicerExport::Frame& frame) {
  return {frame.position,
          frame.target,
          frame.up,
          frame.isOrthographic,
          frame.isOrthographic ? 0.0 : frame.extent,
          frame.isOrthographic ? frame.extent : 0.0,
          {0.0, 0.0},
          frame.fullWidth,
          frame.fullHeight};
}

} // namespace

qSlicerFenestraLiveView::qSlicerFenestraLiveView(vtkSlicerFenestraLogic* logic,
                                                 qSlicerFenestraSession* session)
    : QObject(session), m_logic(logic), m_session(session) {
  m_clock.start();
  m_timer.setSingleShot(true);
  connect(&m_timer, &QTimer::timeout, this, &qSlicerFenestraLiveView::advance);
  connect(session, &qSlicerFenestraSession::previewReceived, this,
          [this](const QImage&, const qFenestraPreviewImage& picture) { receive(picture); });
  connect(session, &qSlicerFenestraSession::previewRefused, this,
          &qSlicerFenestraLiveView::clearImage);
  constexpr int retryInterval = 500; // ms
  m_retryTimer.setSingleShot(true);
  m_retryTimer.setInterval(retryInterval);
  connect(&m_retryTimer, &QTimer::timeout, this, &qSlicerFenestraLiveView::update);
  qvtkConnect(logic, vtkSlicerFenestraLogic::OpeningChangedEvent, this, SLOT(onOpeningChanged()));
  onOpeningChanged();
}

void qSlicerFenestraLiveView::onOpeningChanged() {
  vtkMRMLFenestraOpeningNode* opening = m_logic->GetOpening();
  qvtkReconnect(m_opening, opening, vtkCommand::ModifiedEvent, this, SLOT(update()));
  m_opening = opening;
  update();
}

void qSlicerFenestraLiveView::update() {
  const bool isWanted = m_opening && m_opening->GetPhotorealistic();
  Node* settings = isWanted ? m_opening->GetSettings() : nullptr;
  observe(settings);
  if (!vtkSlicerFenestraLogic::CanShowPhotorealistic(settings))
    settings = nullptr;
  if (followView(settings)) {
    if (!m_state.isOn())
      m_state.turnOn(now());
  } else if (m_state.isOn()) {
    m_state.turnOff();
    m_session->previewView(nullptr, {});
    clearImage();
  }
  if (isWanted && !m_state.isOn()) // a scene is being loaded, or the layout has no 3D view
    m_retryTimer.start();
  advance();
}

void qSlicerFenestraLiveView::clearImage() {
  m_frame = nullptr;
  if (m_opening)
    m_opening->SetImage({});
}

/// Observes the nodes that the image shows, instead of those observed before.
void qSlicerFenestraLiveView::observe(Node* settings) {
  const auto reconnect = [this](auto& observed, auto* node, const auto& events) {
    if (observed == node)
      return;
    for (const unsigned long event : events)
      qvtkReconnect(observed, node, event, this, SLOT(onDataChanged()));
    observed = node;
  };
  const auto& events = vtkSlicerFenestraLogic::GetDataEvents();
  reconnect(m_settings, settings, std::vector<unsigned long>{vtkCommand::ModifiedEvent});
  reconnect(m_volume, settings ? settings->GetNodeReference(Node::VolumeRole) : nullptr, events);
  reconnect(m_segmentation, settings ? settings->GetNodeReference(Node::SegmentationRole) : nullptr,
            events);
}

/// Observes the settings' view. Returns false if there is none.
bool qSlicerFenestraLiveView::followView(Node* settings) {
  qMRMLThreeDWidget* widget =
      settings ? qSlicerFenestra3DViews::findWidget(settings->GetNodeReference(Node::ViewRole))
               : nullptr;
  vtkMRMLViewNode* view = widget ? widget->mrmlViewNode() : nullptr;
  vtkMRMLCameraNode* camera = m_logic->GetCamera(view);
  vtkRenderWindow* window = camera ? widget->threeDView()->renderWindow() : nullptr;
  const bool isOther = m_camera != camera || m_window != window;
  if (isOther) {
    qvtkReconnect(m_camera, camera, vtkCommand::ModifiedEvent, this, SLOT(onViewChanged()));
    qvtkReconnect(m_window, window, vtkCommand::WindowResizeEvent, this, SLOT(onViewChanged()));
  }
  m_view = view;
  m_camera = camera;
  m_window = window;
  if (isOther && window && m_state.isOn()) {
    m_state.moveCamera(now());
    clearImage(); // of the view before
  }
  return window != nullptr;
}

void qSlicerFenestraLiveView::onViewChanged() {
  const auto camera = takeCamera();
  if (!m_state.isOn() ||
      (camera && camera->IsSame(m_seen))) // only the clipping range has changed, for example
    return;
  m_seen = camera.value_or(FenestraViewCamera{});
  if (m_state.moveCamera(now()))
    m_session->pausePreview();
  clearImage();
  advance();
}

void qSlicerFenestraLiveView::onDataChanged() {
  const auto* const volume = m_volume.GetPointer();
  update(); // other nodes may be referenced
  if (m_volume != volume)
    clearImage();
  m_state.change(now());
  advance();
}

void qSlicerFenestraLiveView::advance() {
  if (m_state.takeRequest(now()))
    request();
  if (m_state.takeImage(now()))
    showImage();
  if (const double next = m_state.nextTime(); next < LiveState::never)
    m_timer.start(static_cast<int>(std::ceil(1e3 * std::max(next - now(), 0.0))));
}

/// The view's camera as it is now; nothing: it can have no image.
std::optional<FenestraViewCamera> qSlicerFenestraLiveView::takeCamera() {
  return FenestraViewCamera::FromRenderer(m_window ? m_window->GetRenderers()->GetFirstRenderer()
                                                   : nullptr);
}

void qSlicerFenestraLiveView::request() {
  constexpr int least = 16; // pixels, of a view that is not hidden
  const auto camera = takeCamera();
  if (!m_settings || !m_camera || !camera || std::min(camera->width, camera->height) < least)
    return;
  m_requested = m_seen = *camera;
  qSlicerFenestraSession::Flags flags = vtkSlicerFenestraLogic::GetCameraFlags(m_camera);
  flags["size"] = std::to_string(m_requested.width) + "x" + std::to_string(m_requested.height);
  flags["background"] = "transparent";
  m_session->previewView(m_settings, flags);
}

void qSlicerFenestraLiveView::receive(const qFenestraPreviewImage& picture) {
  if (!m_state.isOn() || !picture.isCurrent || !m_requested.IsSame(toCamera(*picture.frame)))
    return;
  m_frame = picture.frame;
  m_state.receive(picture.frame->isLast);
  advance();
}

void qSlicerFenestraLiveView::showImage() {
  if (!m_opening || !m_frame || !m_view)
    return;
  const auto image = std::make_shared<FenestraViewImage>();
  image->width = m_frame->width;
  image->height = m_frame->height;
  image->rgba = m_frame->display;
  image->depth = m_frame->depth;
  m_opening->SetImage({image, m_requested, m_view->GetID()});
}
